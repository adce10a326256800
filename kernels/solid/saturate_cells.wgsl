// Gardner & Sitar 2018, eq. 10: how much of each cell is solid, and how that solid moves, over all parts that share the
// cell. A workgroup is a brick of the list, an invocation an element.
// needs workgroup, tables, brick

override LANES_OF_ELEMENT: u32;

@group(0) @binding(0) var<storage, read> work: array<u32>;
@group(0) @binding(1) var<storage, read> tiles: array<Tile>;
@group(0) @binding(2) var<storage, read> motions: array<Motion>;
// Tiles of each saturated brick in ascending order, and where they begin.
@group(0) @binding(3) var<storage, read> slot_first: array<u32>;
@group(0) @binding(4) var<storage, read> slot_tiles: array<u32>;
@group(0) @binding(5) var<storage, read> shares: array<f32>;
@group(0) @binding(6) var<storage, read_write> saturation: array<f32>;

@compute @workgroup_size(WORKGROUP)
fn saturate_cells(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let turn = turn_of(group, groups);
    if (turn >= min(TILES, arrayLength(&work))) {
        return;
    }
    let slot = work[turn];
    if (slot == NOTHING) {
        return;
    }
    for (var lane = 0u; lane < LANES_OF_ELEMENT; lane++) {
        let solid = solid_in(slot, lane, local);
        for (var plane = 0u; plane < 4u; plane++) {
            saturation[((slot * PLANES + plane) * WORKGROUP + local) * LANES_OF_ELEMENT + lane] = solid[plane];
        }
    }
}

// Sum of the shares, with its marks, and velocity of the solid.
fn solid_in(slot: u32, lane: u32, local: u32) -> vec4<f32> {
    var sum = 0.0;
    var flux = vec3(0.0);
    var deep = false;
    var near = false;
    for (var k = slot_first[slot]; k < slot_first[slot + 1u]; k++) {
        let tile = tiles[slot_tiles[k]];
        if (tile.lane != lane) {
            continue;
        }
        let mark = shares[slot_tiles[k] * WORKGROUP + local];
        near = near || mark < 0.0;
        if (mark <= 0.0) {
            continue;
        }
        deep = deep || mark == DEEP;
        let share = min(mark, 1.0);
        let motion = motions[tile.block];
        let cell = tile.cell + vec3<i32>(place_in_brick(local));
        sum += share;
        flux += share * velocity_at(motion, centre_from(cell, motion.base, motion.fraction));
    }
    if (sum == 0.0) {
        return vec4(select(0.0, NEAR, near), vec3(0.0));
    }
    return vec4(sum + select(0.0, DEEP_SUM, deep), flux / sum);
}
