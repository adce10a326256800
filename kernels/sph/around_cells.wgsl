// The particles around one, straight from their cells: meet_water and meet_shell are called for more than those
// within the support.
// needs particle_grid, $runs, water_cells

@group(0) @binding(11) var<storage, read> shell_starts: array<u32>;

fn around(n: u32, at: vec3<i32>) {
    around_water(n, at);
    let home = cell_of(at);
    for (var k = 0; k < RUNS; k++) {
        let cells = run(home, k);
        for (var j = shell_starts[cells.x]; j < shell_starts[cells.y]; j++) {
            meet_shell(j);
        }
    }
}
