// Verlet 1967, Phys. Rev. 159:98: writes the fluid particles within the list radius of a point into a list.
// needs cell_grid, $cell_ranges, neighbour_list_layout

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
@group(0) @binding(1) var<storage, read> starts: array<u32>;
@group(0) @binding(4) var<storage, read_write> neighbour_list_out: array<u32>;

// Writes as many as the list holds, and returns how many there are.
fn list_fluid_neighbours(at: vec3<i32>, first: u32) -> u32 {
    let home = cell_of(at);
    var count = 0u;
    for (var k = 0; k < CELL_RANGES; k++) {
        let cells = cell_range(home, k);
        for (var j = starts[cells.x]; j < starts[cells.y]; j++) {
            let r = separation(at, particles[j].at);
            if (dot(r, r) < LIST_SQUARED) {
                if (count < CAPACITY) {
                    neighbour_list_out[first + 64u * count] = j;
                }
                count++;
            }
        }
    }
    return count;
}
