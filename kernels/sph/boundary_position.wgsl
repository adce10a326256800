// Adami, Hu & Adams 2012, J. Comput. Phys. 231:7057: positions and velocities of boundary particles
// from the motion of their bodies.
// needs invocation, cell_grid, $cell_ranges, bodies, clock

@group(0) @binding(0) var<storage, read> reference_positions: array<ReferencePosition>;
@group(0) @binding(1) var<storage, read> motions: array<BodyMotion>;
@group(0) @binding(2) var<storage, read> clock: Clock;
@group(0) @binding(3) var<storage, read_write> unsorted: array<Particle>;
// In the order of the last sort.
@group(0) @binding(4) var<storage, read> boundary: array<Particle>;

@compute @workgroup_size(64)
fn boundary_position(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= arrayLength(&reference_positions) || clock.step == 0.0) {
        return;
    }
    let id = boundary[n].id;
    let reference = reference_positions[id];
    let motion = motions[reference.body];
    let velocity = velocity_at(motion, reference.position);
    let offset = lever(motion, reference.position) + clock.elapsed * velocity;
    let at = wrapped(motion.centre + vec3<i32>(round(offset / QUANTUM)));
    let cells = vec3(CELLS_X, CELLS_Y, CELLS_Z);
    let inside = all(at >= vec3(0)) && all(cell_of(at) < cells);
    unsorted[n] = Particle(select(vec3(-1), at, inside), id, velocity, 0.0);
}
