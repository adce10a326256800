// Gardner & Sitar 2018, fig. 3: the fractions of one part in each cell that voxelise has left undecided.
// needs workgroup, tables, brick, $sphere_fraction, $polyhedron_fraction

@group(0) @binding(1) var<storage, read> tiles: array<Tile>;
@group(0) @binding(2) var<storage, read> parts: array<Part>;
@group(0) @binding(4) var<storage, read_write> solid_fractions: array<f32>;
@group(0) @binding(7) var<storage, read_write> effective_fractions: array<vec2<f32>>;

struct Edges {
    count: u32,
    // Indices into `solid_fractions`.
    cells: array<u32>,
}

@group(0) @binding(5) var<storage, read> edges: Edges;

// The host does not know the number of cells: each invocation continues until none are left.
@compute @workgroup_size(64)
fn voxelise_edges(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let stride = 64u * groups.x * groups.y;
    for (var n = 64u * workgroup_index(group, groups) + local; n < edges.count; n += stride) {
        let place = edges.cells[n];
        let tile = tiles[place / WORKGROUP];
        let part = parts[tile.part];
        let cell = tile.cell + vec3<i32>(place_in_brick(place % WORKGROUP));
        var fractions: Fractions;
        if (part.faces == 0u) {
            fractions = sphere_fraction(part, cell);
        } else {
            fractions = polyhedron_fraction(part, centre_from(cell, part.base, part.fraction));
        }
        solid_fractions[place] = select(NEAR, fractions.solid, fractions.solid > 0.0);
        effective_fractions[place] = fractions.effective;
    }
}
