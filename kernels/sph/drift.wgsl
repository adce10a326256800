// Fourtakas et al. 2019, Comput. Fluids 190:346, continuity with density diffusion, and the way of the particles:
// both with the velocities at the end of the step.
// needs invocation, particle_grid, $runs, wendland, clock_shared, $around

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
@group(0) @binding(2) var<storage, read> shell: array<Particle>;
@group(0) @binding(4) var<storage, read> fresh: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> moved: array<Particle>;
@group(0) @binding(6) var<storage, read_write> clock: ClockShared;

override GRAVITY_X: f32 = 0.0;
override GRAVITY_Y: f32 = 0.0;
override GRAVITY_Z: f32 = 0.0;
// delta.
override DENSITY_DIFFUSION: f32 = 0.0;
// Where a particle is still in the domain or not yet through a wall, quanta.
override KEPT_FROM_X: i32 = 0;
override KEPT_FROM_Y: i32 = 0;
override KEPT_FROM_Z: i32 = 0;
override KEPT_TO_X: i32 = 0;
override KEPT_TO_Y: i32 = 0;
override KEPT_TO_Z: i32 = 0;

// The particle, its new velocity and the sums over those around it.
var<private> here: Particle;
var<private> velocity: vec3<f32>;
var<private> flux: f32;
var<private> diffusion: f32;

fn meet_water(j: u32) {
    let other = particles[j];
    let other_velocity = fresh[j].xyz;
    let r = between(here.at, other.at);
    let square = dot(r, r);
    let share = slope(sqrt(square)) / (1.0 + other.excess);
    // In still water the density differs by what the water between the two weighs.
    let excess = other.excess - here.excess + dot(vec3(GRAVITY_X, GRAVITY_Y, GRAVITY_Z), r);
    if (square < SUPPORT_SQUARED) {
        flux += share * dot(velocity - other_velocity, r);
        diffusion += share * excess;
    }
}

fn meet_shell(j: u32) {
    let other = shell[j];
    let r = between(here.at, other.at);
    let square = dot(r, r);
    if (square < SUPPORT_SQUARED) {
        flux += slope(sqrt(square)) * dot(velocity - other.velocity, r);
    }
}

@compute @workgroup_size(64)
fn drift(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = particle_of(invocation(group, groups, local));
    if (n >= arrayLength(&particles)) {
        return;
    }
    here = particles[n];
    let step = clock.step;
    if (here.at.x < 0 || step == 0.0) {
        moved[n] = here;
        return;
    }
    velocity = fresh[n].xyz;
    flux = 0.0;
    diffusion = 0.0;
    around(n, here.at);
    let density = 1.0 + here.excess;
    let rate = 2.0 * DENSITY_DIFFUSION * SMOOTHING * diffusion - density * flux;
    here.excess += step * rate;
    here.velocity = velocity;
    // Exponents of all ones: neither infinite nor undefined numbers may become places.
    let bits = bitcast<vec4<u32>>(vec4(here.velocity, here.excess)) & vec4(0x7f800000u);
    if (any(bits == vec4(0x7f800000u))) {
        atomicMax(&clock.fault, here.id + 1u);
        moved[n] = particles[n];
        return;
    }
    let at = wrapped(here.at + vec3<i32>(round(step * velocity / QUANTUM)));
    let from_ = vec3(KEPT_FROM_X, KEPT_FROM_Y, KEPT_FROM_Z);
    let to = vec3(KEPT_TO_X, KEPT_TO_Y, KEPT_TO_Z);
    if (any(at < from_) || any(at >= to)) {
        atomicAdd(&clock.escaped, 1u);
        moved[n] = Particle(vec3(-1), here.id, vec3(0.0), 0.0);
        return;
    }
    here.at = at;
    moved[n] = here;
}
