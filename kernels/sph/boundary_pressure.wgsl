// Adami, Hu & Adams 2012, J. Comput. Phys. 231:7057, eq. 27: the pressure of the water at a wall, extrapolated
// to its boundary particles.
// needs invocation, cell_grid, $cell_ranges, extrapolated_pressure, wendland, bodies, clock, $fluid_neighbours, $wall_velocity

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
@group(0) @binding(2) var<storage, read_write> boundary: array<Particle>;
@group(0) @binding(3) var<storage, read> reference_positions: array<ReferencePosition>;
@group(0) @binding(4) var<storage, read> motions: array<BodyMotion>;
@group(0) @binding(5) var<storage, read> clock: Clock;

// Position of the particle.
var<private> at: vec3<i32>;

fn visit_fluid(j: u32, counts: bool) {
    let other = particles[j];
    let r = separation(at, other.at);
    let square = dot(r, r);
    let inside = counts & (square < SUPPORT_SQUARED);
    if (is_added(inside)) {
        let w = select(0.0, weight(sqrt(square)), inside);
        add_pressure(w, r, other.excess);
        add_wall_velocity(w, other.velocity);
    }
}

@compute @workgroup_size(64)
fn boundary_pressure(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = particle_of(invocation(group, groups, local));
    if (n >= arrayLength(&boundary) || clock.step == 0.0) {
        return;
    }
    let here = boundary[n];
    if (here.at.x < 0) {
        return;
    }
    at = here.at;
    reset_pressure();
    visit_fluid_neighbours(n, at);
    let reference = reference_positions[here.id];
    let motion = motions[reference.body];
    boundary[n].excess = extrapolated_pressure(acceleration_at(motion, reference.position));
    store_wall_velocity(n, motion.no_slip, here.velocity);
}
