// Monaghan 2005, Rep. Prog. Phys. 68:1703: what the water does to each particle of the shells of bodies that
// somebody asks about; the opposite of what these do to the water.
// needs invocation, particle_grid, $runs, $state, wendland, clock, $around_water, $drag

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
@group(0) @binding(2) var<storage, read> shell: array<Particle>;
// One a particle of a shell, by its number; the shells that are asked about come first.
@group(0) @binding(3) var<storage, read_write> forces: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> clock: Clock;

// The particle, its place in the shells, its density, and the sum over the water around it.
var<private> here: Particle;
var<private> number: u32;
var<private> density: f32;
var<private> force: vec3<f32>;

fn meet_water(j: u32) {
    let other = particles[j];
    let r = between(here.at, other.at);
    let square = dot(r, r);
    let densities = density * (1.0 + other.excess);
    let push = (pressure_of(other.excess) + here.excess) / densities;
    if (square < SUPPORT_SQUARED) {
        let steep = slope(sqrt(square));
        force += push * steep * r;
        drag(number, steep / densities, other.velocity);
    }
}

@compute @workgroup_size(64)
fn shell_force(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = particle_of(invocation(group, groups, local));
    if (n >= arrayLength(&shell) || clock.step == 0.0) {
        return;
    }
    here = shell[n];
    number = n;
    if (here.id >= arrayLength(&forces)) {
        return;
    }
    force = vec3(0.0);
    if (here.at.x >= 0) {
        density = 1.0 + excess_of(here.excess);
        around_water(n, here.at);
    }
    forces[here.id] = vec4(force, 0.0);
}
