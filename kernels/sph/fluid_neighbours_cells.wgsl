// Visits the fluid particles in the cells around a point: calls visit_fluid(j, counts), also for particles beyond the
// support, and with `counts` false for repeated visits.
// needs cell_grid, $cell_ranges, neighbour_batch

// Index of the first particle of each cell.
@group(0) @binding(10) var<storage, read> starts: array<u32>;

// Index of the particle of an invocation.
fn particle_of(invocation: u32) -> u32 {
    return invocation;
}

fn visit_fluid_neighbours(n: u32, at: vec3<i32>) {
    let home = cell_of(at);
    for (var k = 0; k < CELL_RANGES; k++) {
        let cells = cell_range(home, k);
        let end = starts[cells.y];
        for (var j = starts[cells.x]; j < end; j += NEIGHBOURS_PER_BATCH) {
            for (var i = 0u; i < 4u; i++) { // unroll
                if (i < NEIGHBOURS_PER_BATCH) {
                    visit_fluid(clamped_index(j, i, end), is_before(j, i, end));
                }
            }
        }
    }
}
