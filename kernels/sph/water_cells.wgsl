// The particles of the water around a place, straight from their cells: meet_water is called for more than those
// within the support.
// needs particle_grid, $runs

// Where each cell begins.
@group(0) @binding(10) var<storage, read> starts: array<u32>;

// The number of the particle that an invocation is for.
fn particle_of(invocation: u32) -> u32 {
    return invocation;
}

fn around_water(n: u32, at: vec3<i32>) {
    let home = cell_of(at);
    for (var k = 0; k < RUNS; k++) {
        let cells = run(home, k);
        for (var j = starts[cells.x]; j < starts[cells.y]; j++) {
            meet_water(j);
        }
    }
}
