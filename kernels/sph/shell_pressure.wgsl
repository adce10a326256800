// Adami, Hu & Adams 2012, J. Comput. Phys. 231:7057, eq. 27: the pressure of the water beside a wall, continued into it.
// needs invocation, particle_grid, $runs, $state, wendland, bodies, clock, $around_water, $cling

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
@group(0) @binding(2) var<storage, read_write> shell: array<Particle>;
@group(0) @binding(3) var<storage, read> homes: array<Home>;
@group(0) @binding(4) var<storage, read> motions: array<Motion>;
@group(0) @binding(5) var<storage, read> clock: Clock;

override GRAVITY_X: f32 = 0.0;
override GRAVITY_Y: f32 = 0.0;
override GRAVITY_Z: f32 = 0.0;

// Where the particle is, and the sums over the water around it.
var<private> at: vec3<i32>;
var<private> weights: f32;
var<private> pressure: f32;
var<private> column: vec3<f32>;

fn meet_water(j: u32) {
    let other = particles[j];
    let r = between(at, other.at);
    let square = dot(r, r);
    if (square < SUPPORT_SQUARED) {
        let w = weight(sqrt(square));
        weights += w;
        pressure += w * pressure_of(other.excess);
        column += w * (1.0 + other.excess) * r;
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
    weights = 0.0;
    pressure = 0.0;
    column = vec3(0.0);
    around_water(n, at);
    let home = homes[here.id];
    let motion = motions[home.body];
    let fall = vec3(GRAVITY_X, GRAVITY_Y, GRAVITY_Z) - acceleration_at(motion, home.place);
    // Walls do not pull; where there is no water there is no pressure.
    let sum = max(pressure + dot(fall, column), 0.0);
    shell[n].excess = select(0.0, sum / weights, weights > 0.0);
    keep_velocity(n, motion.clings, here.velocity);
}
