// Visits the fluid and boundary particles in the cells around a particle; particles beyond the support are visited too.
// needs cell_grid, $cell_ranges, fluid_neighbours_cells

@group(0) @binding(11) var<storage, read> boundary_starts: array<u32>;

fn visit_neighbours(n: u32, at: vec3<i32>) {
    visit_fluid_neighbours(n, at);
    let home = cell_of(at);
    for (var k = 0; k < CELL_RANGES; k++) {
        let cells = cell_range(home, k);
        let end = boundary_starts[cells.y];
        for (var j = boundary_starts[cells.x]; j < end; j += NEIGHBOURS_PER_BATCH) {
            for (var i = 0u; i < 4u; i++) { // unroll
                if (i < NEIGHBOURS_PER_BATCH) {
                    visit_boundary(clamped_index(j, i, end), is_before(j, i, end));
                }
            }
        }
    }
}
