// Monaghan 2005, Rep. Prog. Phys. 68:1703, momentum with artificial viscosity: the velocities at the end of the step,
// and how long the next one may be. Cercos-Pita et al. 2017, Comput. Methods Appl. Mech. Eng. 317:771: what energy the
// particles of shells give beyond the work of their bodies.
// needs invocation, particle_grid, $runs, $state, wendland, clock, shelter, $around, $friction

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
@group(0) @binding(2) var<storage, read> shell: array<Particle>;
// Velocity, and the longest step.
@group(0) @binding(4) var<storage, read_write> fresh: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> clock: Clock;
@group(0) @binding(6) var<storage, read_write> shelter: array<Shelter>;

override GRAVITY_X: f32 = 0.0;
override GRAVITY_Y: f32 = 0.0;
override GRAVITY_Z: f32 = 0.0;
// alpha.
override ARTIFICIAL_VISCOSITY: f32 = 0.0;
override COURANT: f32 = 0.2;

// No particle that has left limits the step.
const ENDLESS = 1e30;
// Water that is farther than this from all particles of shells is in none of them: a first layer lies half a spacing
// deep, and the middle of its meshes is 0.8 spacings from it at most.
const NEAR = 0.95;

// The particle and the sums over those around it.
var<private> here: Particle;
var<private> pressure: f32;
var<private> rate: vec3<f32>;
var<private> shear: f32;
var<private> nearest: f32;
// Sums of what shells give: times the velocity of the particle, and of theirs.
var<private> given: vec3<f32>;
var<private> taken: f32;

fn meet_water(j: u32) {
    let other = particles[j];
    let r = between(here.at, other.at);
    let square = dot(r, r);
    let density = 1.0 + here.excess;
    let other_density = 1.0 + other.excess;
    let push = (pressure + pressure_of(other.excess)) / (density * other_density);
    let mu = SMOOTHING * dot(here.velocity - other.velocity, r) / (square + 0.01 * SMOOTHING * SMOOTHING);
    let viscous = -2.0 * ARTIFICIAL_VISCOSITY * min(mu, 0.0) / (density + other_density);
    if (square < SUPPORT_SQUARED) {
        shear = max(shear, abs(mu));
        let steep = slope(sqrt(square));
        rate += (push + viscous) * steep * r;
        rub_water(steep / (density * other_density), other.velocity);
    }
}

fn meet_shell(j: u32) {
    let other = shell[j];
    let r = between(here.at, other.at);
    let square = dot(r, r);
    let densities = (1.0 + here.excess) * (1.0 + excess_of(other.excess));
    let push = (pressure + other.excess) / densities;
    if (square < SUPPORT_SQUARED) {
        let steep = slope(sqrt(square));
        rate += push * steep * r;
        // Kinetic energy by this push, energy of compression by the density that drift will give it.
        let beyond = (push - pressure / (1.0 + here.excess)) * steep * r;
        given += beyond;
        taken += dot(beyond, other.velocity);
        nearest = min(nearest, square);
        rub_shell(j, steep / densities);
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
        fresh[n] = vec4(0.0, 0.0, 0.0, ENDLESS);
        shelter[n] = Shelter(0u, 0.0, 0.0);
        return;
    }
    pressure = pressure_of(here.excess);
    rate = vec3(GRAVITY_X, GRAVITY_Y, GRAVITY_Z);
    shear = 0.0;
    nearest = ENDLESS;
    given = vec3(0.0);
    taken = 0.0;
    around(n, here.at);
    let velocity = here.velocity + clock.step * rate;
    // Velocity changes evenly in a step.
    let middle = 0.5 * (here.velocity + velocity);
    let near_ = select(0u, 1u, nearest < NEAR * NEAR);
    shelter[n] = Shelter(near_, clock.step * (dot(given, middle) - taken), 0.0);
    let by_force = sqrt(SMOOTHING / max(length(rate), 1e-30));
    let by_sound = SMOOTHING / (max(1.0, 10.0 * length(velocity)) + shear);
    fresh[n] = vec4(velocity, min(COURANT * min(by_force, by_sound), longest_step()));
}
