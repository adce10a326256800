// The time of the particles within an exchange with the host.

struct Clock {
    // Length of the next step; 0 when the exchange is complete.
    step: f32,
    // Upper bound on the length of the next step.
    step_limit: f32,
    // Time since the start of the exchange.
    elapsed: f32,
    // Time to the end of the exchange.
    remaining: f32,
    // Steps since the start of the exchange.
    steps: u32,
    // Highest id of a particle with a non-finite state, plus 1; 0 if there is none.
    invalid_particle: u32,
    // Particles that have left the domain since the start.
    escaped: u32,
    // Length of the longest list of a fluid particle that exceeds its capacity; 0 if none does.
    overflow: u32,
    // Length of the step that is postponed until the lists have been enlarged.
    pending_step: f32,
    // Length of the longest list of a boundary particle that exceeds its capacity; 0 if none does.
    boundary_overflow: u32,
    // 1: the next step sorts the particles and rebuilds the neighbour lists.
    stale: u32,
    // Bound on the approach of any two particles since the lists were built.
    list_displacement: f32,
    // Largest speed of any boundary particle.
    max_body_speed: f32,
    // Escaped particles when the lists were last checked: more of them make the lists stale.
    escaped_at_sort: u32,
    // Steps since the start of the exchange that sorted the particles.
    sorts: u32,
    // Largest speed at the end of any step since the start.
    max_speed: f32,
    // Work since the start of the exchange: of boundary particles beyond the work of their bodies, and of the penalty
    // force.
    boundary_work: f32,
    penalty_work: f32,
    // Particles that crossed the periodic boundary of each axis upwards since the start of the exchange, less those
    // downwards.
    crossings_x: i32,
    crossings_y: i32,
    crossings_z: i32,
}
