// Visits the fluid particles in the neighbour list of a particle.
// needs cell_grid, $cell_ranges, neighbour_list_layout

@group(0) @binding(10) var<storage, read> neighbour_list: array<u32>;
// Number of fluid neighbours of each particle, and of all its neighbours.
@group(0) @binding(11) var<storage, read> neighbour_counts: array<vec2<u32>>;

fn visit_fluid_neighbours(n: u32, at: vec3<i32>) {
    let first = list_start(n);
    let count = neighbour_counts[n].x;
    for (var k = 0u; k < count; k++) {
        visit_fluid(neighbour_list[first + 64u * k]);
    }
}
