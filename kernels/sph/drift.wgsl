// Fourtakas et al. 2019, Comput. Fluids 190:346, continuity with density diffusion, and the way of the particles:
// both with the velocities at the end of the step.
// needs invocation, particle_grid, $runs, wendland, clock_shared, arrive, $around

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
@group(0) @binding(2) var<storage, read> shell: array<Particle>;
@group(0) @binding(4) var<storage, read> fresh: array<vec4<f32>>;

override GRAVITY_X: f32 = 0.0;
override GRAVITY_Y: f32 = 0.0;
override GRAVITY_Z: f32 = 0.0;
// delta.
override DENSITY_DIFFUSION: f32 = 0.0;
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
    arrive(n, here);
}
