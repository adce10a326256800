// The time of the particles within an exchange with the host.

struct Clock {
    // Length of the coming step; 0: the exchange is over and nothing moves.
    step: f32,
    // Longest step that the last one allowed.
    limit: f32,
    // From the start of the exchange.
    elapsed: f32,
    // To its end.
    left: f32,
    // Steps since the start of the exchange.
    steps: u32,
    // 1 and the highest id of a particle that is nowhere, or 0.
    fault: u32,
    // Particles that have left since the start.
    escaped: u32,
    // The longest list of neighbours that had no room; 0 if all had.
    crowd: u32,
    // The step that waits for room.
    held: f32,
    // The longest list of a shell's particle that had no room; 0 if all had.
    shell_crowd: u32,
    // 1: the coming step sorts the particles anew and makes the lists of neighbours.
    stale: u32,
    // By how much two particles may have come nearer since the lists were made.
    travel: f32,
    // The fastest that any body moves.
    body_speed: f32,
    // Particles that had left when the lists were looked at last: nobody must meet those any more.
    missed: u32,
    // Steps since the start of the exchange that sorted.
    sorts: u32,
    // The highest speed at the end of any step since the start.
    fastest: f32,
    // Work since the start of the exchange of the particles of shells beyond what their bodies did, and of what pushes water
    // out of bodies.
    pressed: f32,
    pushed: f32,
}
