// Verlet 1967, Phys. Rev. 159:98: lists of the fluid neighbours of each boundary particle, for several steps.
// needs invocation, cell_grid, $cell_ranges, clock_atomic, neighbour_list_layout, list_fluid_neighbours

@group(0) @binding(2) var<storage, read> boundary: array<Particle>;
@group(0) @binding(5) var<storage, read_write> neighbour_counts_out: array<vec2<u32>>;
@group(0) @binding(6) var<storage, read_write> clock: ClockAtomic;

@compute @workgroup_size(64)
fn boundary_neighbour_lists(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = particle_of(invocation(group, groups, local));
    if (n >= arrayLength(&boundary) || clock.step == 0.0 || clock.stale == 0u) {
        return;
    }
    let at = boundary[n].at;
    if (at.x < 0) {
        neighbour_counts_out[n] = vec2(0u);
        return;
    }
    let count = list_fluid_neighbours(at, list_start(n));
    neighbour_counts_out[n] = vec2(min(count, CAPACITY));
    if (count > CAPACITY) {
        atomicMax(&clock.boundary_overflow, count);
    }
}
