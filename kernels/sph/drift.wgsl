// Fourtakas et al. 2019, Comput. Fluids 190:346, continuity with density diffusion, and the displacement of
// the particles, both with the velocities at the end of the step.
// needs invocation, cell_grid, $cell_ranges, wendland, clock_atomic, advect, $neighbours

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
@group(0) @binding(2) var<storage, read> boundary: array<Particle>;
@group(0) @binding(4) var<storage, read> new_velocities: array<vec4<f32>>;

override GRAVITY_X: f32;
override GRAVITY_Y: f32;
override GRAVITY_Z: f32;
// delta.
override DENSITY_DIFFUSION: f32;
// The particle, its new velocity and the sums over its neighbours.
var<private> here: Particle;
var<private> velocity: vec3<f32>;
var<private> flux: f32;
var<private> diffusion: f32;

fn visit_fluid(j: u32, counts: bool) {
    let other = particles[j];
    let other_velocity = new_velocities[j].xyz;
    let r = separation(here.at, other.at);
    let square = dot(r, r);
    let weight = slope(sqrt(square)) / (1.0 + other.excess);
    // Less the hydrostatic difference of density.
    let excess = other.excess - here.excess + dot(vec3(GRAVITY_X, GRAVITY_Y, GRAVITY_Z), r);
    let inside = counts & (square < SUPPORT_SQUARED);
    if (is_added(inside)) {
        flux += select(0.0, weight * dot(velocity - other_velocity, r), inside);
        diffusion += select(0.0, weight * excess, inside);
    }
}

fn visit_boundary(j: u32, counts: bool) {
    let other = boundary[j];
    let r = separation(here.at, other.at);
    let square = dot(r, r);
    let inside = counts & (square < SUPPORT_SQUARED);
    if (is_added(inside)) {
        flux += select(0.0, slope(sqrt(square)) * dot(velocity - other.velocity, r), inside);
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
    velocity = new_velocities[n].xyz;
    flux = 0.0;
    diffusion = 0.0;
    visit_neighbours(n, here.at);
    let density = 1.0 + here.excess;
    let rate = 2.0 * DENSITY_DIFFUSION * SMOOTHING * diffusion - density * flux;
    here.excess += step * rate;
    here.velocity = velocity;
    advect(n, here);
}
