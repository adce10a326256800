// Gardner & Sitar 2018, fig. 3: the solid fraction, volume of (cell and convex part) / volume of the cell, of one part
// in each cell of the listed tiles that it can reach, and its effective fraction, which determines the weight of the
// solid. A workgroup processes a tile; its invocations share the cells. Cells at edges and on spheres are few and expensive:
// they are appended to a list for voxelise_edges, in any order, because other cells of the workgroup would wait for them.
// needs tables, brick, $sphere_quick, $polyhedron_quick

@group(0) @binding(0) var<storage, read> work: array<u32>;
@group(0) @binding(1) var<storage, read> tiles: array<Tile>;
@group(0) @binding(2) var<storage, read> parts: array<Part>;
// WORKGROUP numbers per tile.
@group(0) @binding(4) var<storage, read_write> solid_fractions: array<f32>;
@group(0) @binding(7) var<storage, read_write> effective_fractions: array<vec2<f32>>;

struct Edges {
    count: atomic<u32>,
    // Indices into `solid_fractions`.
    cells: array<u32>,
}

@group(0) @binding(5) var<storage, read_write> edges: Edges;

@compute @workgroup_size(INVOCATIONS)
fn voxelise(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let index = workgroup_index(group, groups);
    if (index >= arrayLength(&work)) {
        return;
    }
    let job = work[index];
    if (job == NOTHING) {
        return;
    }
    let number = job & ~WHOLE;
    let tile = tiles[number];
    let part = parts[tile.part];
    let reach = select(reach_of(tile.inside), vec2(0u, WORKGROUP), job >= WHOLE);
    for (var place = reach.x + local; place < reach.y; place += INVOCATIONS) {
        let fractions = quick_fractions(tile, part, place_in_brick(place));
        solid_fractions[number * WORKGROUP + place] = fractions.x;
        effective_fractions[number * WORKGROUP + place] = fractions.yy;
        if (fractions.x == UNDECIDED) {
            edges.cells[atomicAdd(&edges.count, 1u)] = number * WORKGROUP + place;
        }
    }
}

// The solid fraction, or a mark, and the effective fraction.
fn quick_fractions(tile: Tile, part: Part, place: vec3<u32>) -> vec2<f32> {
    if (!in_domain(place, tile.inside)) {
        return vec2(0.0);
    }
    let cell = tile.cell + vec3<i32>(place);
    if (part.faces == 0u) {
        let fraction = sphere_quick(part, cell);
        return vec2(fraction, clamp(fraction, 0.0, 1.0));
    }
    return polyhedron_quick(part, centre_from(cell, part.base, part.fraction));
}
