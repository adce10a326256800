// Müller, Charypar & Gross 2003, eqs. 10 and 14, and Geraili Mikola & Sitar 2014, eqs. 17-22: velocities at the end
// of the step by pressure, viscosity, gravity and the penalty force of bodies.
// needs invocation, cell_grid, $cell_ranges, mueller_kernels, penalty, $neighbours

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
@group(0) @binding(4) var<storage, read_write> new_velocities: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> clock: Clock;

override GRAVITY_X: f32;
override GRAVITY_Y: f32;
override GRAVITY_Z: f32;
// Kinematic viscosity.
override VISCOSITY: f32;
override COURANT: f32;
override SMOOTHING: f32;

// Step limit of an escaped particle.
const NO_LIMIT = 1e30;

var<private> here: Particle;
var<private> rate: vec3<f32>;

fn visit_fluid(j: u32, counts: bool) {
    let other = particles[j];
    let r = separation(here.at, other.at);
    let square = dot(r, r);
    let distance = sqrt(square);
    let other_density = 1.0 + other.excess;
    let push = 0.5 * (here.excess + other.excess) / other_density * spiky_slope(distance);
    let drag = VISCOSITY / other_density * laplacian(distance);
    let inside = counts & (square < SUPPORT_SQUARED) & (square > 0.0);
    if (is_added(inside)) {
        rate += select(vec3(0.0), push / distance * r + drag * (other.velocity - here.velocity), inside);
    }
}

// This scheme has no boundary particles.
fn visit_boundary(j: u32, counts: bool) {}

@compute @workgroup_size(64)
fn mueller_accelerate(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = particle_of(invocation(group, groups, local));
    if (n >= arrayLength(&particles) || clock.step == 0.0) {
        return;
    }
    here = particles[n];
    if (here.at.x < 0) {
        new_velocities[n] = vec4(0.0, 0.0, 0.0, NO_LIMIT);
        return;
    }
    rate = vec3(0.0);
    visit_neighbours(n, here.at);
    rate = rate / (1.0 + here.excess) + vec3(GRAVITY_X, GRAVITY_Y, GRAVITY_Z);
    for (var k = 0u; k < arrayLength(&hulls); k++) {
        rate += penalty(hulls[k], here.at, here.velocity, clock.elapsed);
    }
    let velocity = here.velocity + clock.step * rate;
    let by_force = sqrt(SMOOTHING / max(length(rate), 1e-30));
    let by_sound = SMOOTHING / max(1.0, 10.0 * length(velocity));
    let by_viscosity = SMOOTHING * SMOOTHING / max(VISCOSITY, 1e-30);
    new_velocities[n] = vec4(velocity, COURANT * min(min(by_force, by_sound), by_viscosity));
}
