// Visits the fluid particles in the neighbour list of a particle, as fluid_neighbours_cells.wgsl does.
// needs cell_grid, $cell_ranges, neighbour_list_layout, neighbour_batch

@group(0) @binding(10) var<storage, read> neighbour_list: array<u32>;
// Number of fluid neighbours of each particle, and of all its neighbours.
@group(0) @binding(11) var<storage, read> neighbour_counts: array<vec2<u32>>;

fn visit_fluid_neighbours(n: u32, at: vec3<i32>) {
    let first = list_start(n);
    let count = neighbour_counts[n].x;
    for (var k = 0u; k < count; k += NEIGHBOURS_PER_BATCH) {
        for (var i = 0u; i < 4u; i++) { // unroll
            if (i < NEIGHBOURS_PER_BATCH) {
                visit_fluid(neighbour_list[first + 64u * clamped_index(k, i, count)], is_before(k, i, count));
            }
        }
    }
}
