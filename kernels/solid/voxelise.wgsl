// Gardner & Sitar 2018, fig. 3: the solid fraction, volume of (cell and convex part) / volume of the cell, of one part
// in each cell of the listed tiles. A workgroup is a tile.
// needs workgroup, tables, brick, ball_share, hull_share

@group(0) @binding(0) var<storage, read> work: array<u32>;
@group(0) @binding(1) var<storage, read> tiles: array<Tile>;
@group(0) @binding(2) var<storage, read> parts: array<Part>;
// WORKGROUP a tile.
@group(0) @binding(4) var<storage, read_write> shares: array<f32>;

@compute @workgroup_size(WORKGROUP)
fn voxelise(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let turn = turn_of(group, groups);
    if (turn >= min(TILES, arrayLength(&work))) {
        return;
    }
    let number = work[turn];
    if (number != NOTHING) {
        shares[number * WORKGROUP + local] = share_of(tiles[number], place_in_brick(local));
    }
}

fn share_of(tile: Tile, place: vec3<u32>) -> f32 {
    if (!in_domain(place, tile.inside)) {
        return 0.0;
    }
    let part = parts[tile.part];
    let r = centre_from(tile.cell + vec3<i32>(place), part.base, part.fraction);
    if (part.faces == 0u) {
        return ball_share(r, part.radius);
    }
    return hull_share(part, r);
}
