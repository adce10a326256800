// Monaghan 2005, Rep. Prog. Phys. 68:1703, momentum with artificial viscosity: the velocities at the end of the step,
// and how long the next one may be.
// needs invocation, particle_grid, $runs, $state, wendland, clock

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
@group(0) @binding(1) var<storage, read> starts: array<u32>;
@group(0) @binding(2) var<storage, read> shell: array<Particle>;
@group(0) @binding(3) var<storage, read> shell_starts: array<u32>;
// Velocity, and the longest step.
@group(0) @binding(4) var<storage, read_write> fresh: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> clock: Clock;

override GRAVITY_X: f32 = 0.0;
override GRAVITY_Y: f32 = 0.0;
override GRAVITY_Z: f32 = 0.0;
// alpha.
override ARTIFICIAL_VISCOSITY: f32 = 0.0;
override COURANT: f32 = 0.2;

// No particle that has left limits the step.
const ENDLESS = 1e30;

@compute @workgroup_size(64)
fn accelerate(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= arrayLength(&particles) || clock.step == 0.0) {
        return;
    }
    let here = particles[n];
    if (here.at.x < 0) {
        fresh[n] = vec4(0.0, 0.0, 0.0, ENDLESS);
        return;
    }
    let cell = cell_of(here.at);
    let pressure = pressure_of(here.excess);
    let density = 1.0 + here.excess;
    var rate = vec3(GRAVITY_X, GRAVITY_Y, GRAVITY_Z);
    var shear = 0.0;
    for (var k = 0; k < RUNS; k++) {
        let cells = run(cell, k);
        for (var j = starts[cells.x]; j < starts[cells.y]; j++) {
            let other = particles[j];
            let r = between(here.at, other.at);
            let square = dot(r, r);
            if (square >= SUPPORT_SQUARED) {
                continue;
            }
            let other_density = 1.0 + other.excess;
            let push = (pressure + pressure_of(other.excess)) / (density * other_density);
            let mu = SMOOTHING * dot(here.velocity - other.velocity, r)
                / (square + 0.01 * SMOOTHING * SMOOTHING);
            shear = max(shear, abs(mu));
            let viscous = -2.0 * ARTIFICIAL_VISCOSITY * min(mu, 0.0) / (density + other_density);
            rate += (push + viscous) * slope(sqrt(square)) * r;
        }
        for (var j = shell_starts[cells.x]; j < shell_starts[cells.y]; j++) {
            let other = shell[j];
            let r = between(here.at, other.at);
            let square = dot(r, r);
            if (square >= SUPPORT_SQUARED) {
                continue;
            }
            let push = (pressure + other.excess) / (density * (1.0 + excess_of(other.excess)));
            rate += push * slope(sqrt(square)) * r;
        }
    }
    let velocity = here.velocity + clock.step * rate;
    let by_force = sqrt(SMOOTHING / max(length(rate), 1e-30));
    let by_sound = SMOOTHING / (max(1.0, 10.0 * length(velocity)) + shear);
    fresh[n] = vec4(velocity, COURANT * min(by_force, by_sound));
}
