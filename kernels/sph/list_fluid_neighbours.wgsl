// Verlet 1967, Phys. Rev. 159:98: writes the fluid particles within the list radius of a point into a list.
// needs cell_grid, $cell_ranges, neighbour_list_layout, neighbour_batch

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
@group(0) @binding(1) var<storage, read> starts: array<u32>;
@group(0) @binding(4) var<storage, read_write> neighbour_list_out: array<u32>;

// Writes as many neighbours as the list holds, and returns the number found.
fn list_fluid_neighbours(at: vec3<i32>, first: u32) -> u32 {
    let home = cell_of(at);
    var count = 0u;
    for (var k = 0; k < CELL_RANGES; k++) {
        let cells = cell_range(home, k);
        let end = starts[cells.y];
        for (var j = starts[cells.x]; j < end; j += NEIGHBOURS_PER_BATCH) {
            var others: array<vec3<i32>, 4>;
            for (var i = 0u; i < 4u; i++) { // unroll
                if (i < NEIGHBOURS_PER_BATCH) {
                    others[i] = particles[clamped_index(j, i, end)].at;
                }
            }
            for (var i = 0u; i < 4u; i++) { // unroll
                if (i < NEIGHBOURS_PER_BATCH) {
                    count = listed(at, others[i], is_before(j, i, end), j + i, first, count);
                }
            }
        }
    }
    return count;
}

// Adds particle j at `other` if `counts` is true and it is within the list radius; returns the new number of neighbours.
fn listed(at: vec3<i32>, other: vec3<i32>, counts: bool, j: u32, first: u32, count: u32) -> u32 {
    let r = separation(at, other);
    if (counts & (dot(r, r) < LIST_SQUARED)) {
        if (count < CAPACITY) {
            neighbour_list_out[first + 64u * count] = j;
        }
        return count + 1u;
    }
    return count;
}
