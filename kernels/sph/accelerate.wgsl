// Monaghan 2005, Rep. Prog. Phys. 68:1703, momentum with artificial viscosity: the velocities at the end of the step,
// and the longest next step. Cercos-Pita et al. 2017, Comput. Methods Appl. Mech. Eng. 317:771: work of boundary
// particles beyond the work of their bodies.
// needs invocation, cell_grid, $cell_ranges, $equation_of_state, wendland, clock, wall_work, $neighbours, $viscous

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
@group(0) @binding(2) var<storage, read> boundary: array<Particle>;
// Velocity at the end of the step, and the longest next step.
@group(0) @binding(4) var<storage, read_write> new_velocities: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> clock: Clock;
@group(0) @binding(6) var<storage, read_write> wall_work: array<WallWork>;

override GRAVITY_X: f32;
override GRAVITY_Y: f32;
override GRAVITY_Z: f32;
// alpha.
override ARTIFICIAL_VISCOSITY: f32;
override COURANT: f32;

// Step limit of an escaped particle.
const NO_LIMIT = 1e30;
// A fluid particle farther than this from all boundary particles is outside of all bodies: the first layer lies half a
// spacing deep, and a point of the surface is 0.8 spacings from its particles at most.
const NEAR_DISTANCE = 0.95;

// The particle, and the sums over its neighbours.
var<private> here: Particle;
var<private> pressure: f32;
var<private> rate: vec3<f32>;
var<private> shear: f32;
var<private> nearest: f32;
// Excess acceleration by boundary particles, and its power at their velocities.
var<private> excess_push: vec3<f32>;
var<private> excess_power: f32;

fn visit_fluid(j: u32, counts: bool) {
    let other = particles[j];
    let r = separation(here.at, other.at);
    let square = dot(r, r);
    let density = 1.0 + here.excess;
    let other_density = 1.0 + other.excess;
    let push = (pressure + pressure_of(other.excess)) / (density * other_density);
    let mu = SMOOTHING * dot(here.velocity - other.velocity, r) / (square + 0.01 * SMOOTHING * SMOOTHING);
    let viscous = -2.0 * ARTIFICIAL_VISCOSITY * min(mu, 0.0) / (density + other_density);
    let inside = counts & (square < SUPPORT_SQUARED);
    if (is_added(inside)) {
        shear = max(shear, select(0.0, abs(mu), inside));
        let steep = select(0.0, slope(sqrt(square)), inside);
        rate += (push + viscous) * steep * r;
        viscous_fluid(steep / (density * other_density), other.velocity);
    }
}

fn visit_boundary(j: u32, counts: bool) {
    let other = boundary[j];
    let r = separation(here.at, other.at);
    let square = dot(r, r);
    let densities = (1.0 + here.excess) * (1.0 + excess_of(other.excess));
    let push = (pressure + other.excess) / densities;
    let inside = counts & (square < SUPPORT_SQUARED);
    if (is_added(inside)) {
        let steep = select(0.0, slope(sqrt(square)), inside);
        rate += push * steep * r;
        // The kinetic energy by this push, less the compression energy by the density change in drift.wgsl.
        let beyond = (push - pressure / (1.0 + here.excess)) * steep * r;
        excess_push += beyond;
        excess_power += dot(beyond, other.velocity);
        nearest = min(nearest, select(NO_LIMIT, square, inside));
        viscous_boundary(j, steep / densities);
    }
}

@compute @workgroup_size(64)
fn accelerate(
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
        wall_work[n] = WallWork(0u, 0.0, 0.0);
        return;
    }
    pressure = pressure_of(here.excess);
    rate = vec3(GRAVITY_X, GRAVITY_Y, GRAVITY_Z);
    shear = 0.0;
    nearest = NO_LIMIT;
    excess_push = vec3(0.0);
    excess_power = 0.0;
    visit_neighbours(n, here.at);
    let velocity = here.velocity + clock.step * rate;
    // The velocity changes linearly in a step.
    let middle = 0.5 * (here.velocity + velocity);
    let near_boundary = select(0u, 1u, nearest < NEAR_DISTANCE * NEAR_DISTANCE);
    wall_work[n] = WallWork(near_boundary, clock.step * (dot(excess_push, middle) - excess_power), 0.0);
    let by_force = sqrt(SMOOTHING / max(length(rate), 1e-30));
    let by_sound = SMOOTHING / (max(1.0, 10.0 * length(velocity)) + shear);
    new_velocities[n] = vec4(velocity, min(COURANT * min(by_force, by_sound), longest_step()));
}
