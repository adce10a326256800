// Visits the fluid particles in the cells around a point; visit_fluid is called for particles beyond the support too.
// needs cell_grid, $cell_ranges

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
        for (var j = starts[cells.x]; j < starts[cells.y]; j++) {
            visit_fluid(j);
        }
    }
}
