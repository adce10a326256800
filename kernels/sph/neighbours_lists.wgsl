// Visits the fluid and boundary particles in the neighbour list of a particle.
// needs neighbour_list_layout, fluid_neighbours_lists

fn visit_neighbours(n: u32, at: vec3<i32>) {
    visit_fluid_neighbours(n, at);
    let first = list_start(n);
    let counts = neighbour_counts[n];
    for (var k = counts.x; k < counts.y; k += NEIGHBOURS_PER_BATCH) {
        for (var i = 0u; i < 4u; i++) { // unroll
            if (i < NEIGHBOURS_PER_BATCH) {
                visit_boundary(neighbour_list[first + 64u * clamped_index(k, i, counts.y)], is_before(k, i, counts.y));
            }
        }
    }
}
