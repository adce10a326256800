// Monaghan 2005, Rep. Prog. Phys. 68:1703: force of the water on each boundary particle of the bodies with loads, opposite
// to the force of these particles on the water.
// needs invocation, cell_grid, $cell_ranges, $equation_of_state, wendland, clock, $fluid_neighbours, $drag

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
@group(0) @binding(2) var<storage, read> boundary: array<Particle>;
// Forces by the index of the boundary particle, and with a deformable body the pressures on open faces; those of bodies with loads
// come first.
@group(0) @binding(3) var<storage, read_write> forces: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> clock: Clock;

// The particle, its sorted index, its density, and the sum over the water around it.
var<private> here: Particle;
var<private> index: u32;
var<private> density: f32;
var<private> force: vec3<f32>;
// Sum of the kernel function over the water, and the sum from which a particle in the first layer of a face is not in a joint.
var<private> weights: f32;

override OPEN_WEIGHT: f32;

// Whether a body deforms.
override DEFORMS: bool;

fn visit_fluid(j: u32, counts: bool) {
    let other = particles[j];
    let r = separation(here.at, other.at);
    let square = dot(r, r);
    let densities = density * (1.0 + other.excess);
    let push = (pressure_of(other.excess) + here.excess) / densities;
    let inside = counts & (square < SUPPORT_SQUARED);
    if (is_added(inside)) {
        let steep = select(0.0, slope(sqrt(square)), inside);
        force += push * steep * r;
        if (DEFORMS) {
            weights += select(0.0, weight(sqrt(square)), inside);
        }
        drag(index, steep / densities, other.velocity);
    }
}

@compute @workgroup_size(64)
fn boundary_force(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = particle_of(invocation(group, groups, local));
    if (n >= arrayLength(&boundary) || clock.step == 0.0) {
        return;
    }
    here = boundary[n];
    index = n;
    if (here.id >= arrayLength(&forces)) {
        return;
    }
    force = vec3(0.0);
    weights = 0.0;
    if (here.at.x >= 0) {
        density = 1.0 + excess_of(here.excess);
        visit_fluid_neighbours(n, here.at);
    }
    forces[here.id] = vec4(force, select(0.0, here.excess, weights >= OPEN_WEIGHT));
}
