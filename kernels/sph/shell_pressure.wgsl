// Adami, Hu & Adams 2012, J. Comput. Phys. 231:7057, eq. 27: the pressure of the water beside a wall, continued into it.
// needs invocation, particle_grid, $runs, continued, wendland, bodies, clock, $around_water, $cling

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
@group(0) @binding(2) var<storage, read_write> shell: array<Particle>;
@group(0) @binding(3) var<storage, read> homes: array<Home>;
@group(0) @binding(4) var<storage, read> motions: array<Motion>;
@group(0) @binding(5) var<storage, read> clock: Clock;

// Where the particle is.
var<private> at: vec3<i32>;

fn meet_water(j: u32) {
    let other = particles[j];
    let r = between(at, other.at);
    let square = dot(r, r);
    if (square < SUPPORT_SQUARED) {
        let w = weight(sqrt(square));
        add_pressure(w, r, other.excess);
        meet_velocity(w, other.velocity);
    }
}

@compute @workgroup_size(64)
fn shell_pressure(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = particle_of(invocation(group, groups, local));
    if (n >= arrayLength(&shell) || clock.step == 0.0) {
        return;
    }
    let here = shell[n];
    if (here.at.x < 0) {
        return;
    }
    at = here.at;
    begin_pressure();
    around_water(n, at);
    let home = homes[here.id];
    let motion = motions[home.body];
    shell[n].excess = end_pressure(acceleration_at(motion, home.place));
    keep_velocity(n, motion.clings, here.velocity);
}
