// Verlet 1967, Phys. Rev. 159:98: lists of the fluid and boundary neighbours of each fluid particle, for several
// steps.
// needs invocation, cell_grid, $cell_ranges, clock_atomic, neighbour_list_layout, list_fluid_neighbours

@group(0) @binding(2) var<storage, read> boundary: array<Particle>;
@group(0) @binding(3) var<storage, read> boundary_starts: array<u32>;
@group(0) @binding(5) var<storage, read_write> neighbour_counts_out: array<vec2<u32>>;
@group(0) @binding(6) var<storage, read_write> clock: ClockAtomic;

@compute @workgroup_size(64)
fn neighbour_lists(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = particle_of(invocation(group, groups, local));
    if (n >= arrayLength(&particles) || clock.step == 0.0 || clock.stale == 0u) {
        return;
    }
    let at = particles[n].at;
    if (at.x < 0) {
        neighbour_counts_out[n] = vec2(0u);
        return;
    }
    let first = list_start(n);
    let home = cell_of(at);
    var count = list_fluid_neighbours(at, first);
    let water = count;
    for (var k = 0; k < CELL_RANGES; k++) {
        let cells = cell_range(home, k);
        let end = boundary_starts[cells.y];
        for (var j = boundary_starts[cells.x]; j < end; j += NEIGHBOURS_PER_BATCH) {
            var others: array<vec3<i32>, 4>;
            for (var i = 0u; i < 4u; i++) { // unroll
                if (i < NEIGHBOURS_PER_BATCH) {
                    others[i] = boundary[clamped_index(j, i, end)].at;
                }
            }
            for (var i = 0u; i < 4u; i++) { // unroll
                if (i < NEIGHBOURS_PER_BATCH) {
                    count = listed(at, others[i], is_before(j, i, end), j + i, first, count);
                }
            }
        }
    }
    neighbour_counts_out[n] = min(vec2(water, count), vec2(CAPACITY));
    if (count > CAPACITY) {
        atomicMax(&clock.overflow, count);
    }
}
