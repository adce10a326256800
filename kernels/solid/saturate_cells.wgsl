// Gardner & Sitar 2018, eq. 10: how much of each cell is solid, and how that solid moves, over all parts that share the
// cell. A workgroup is a brick of the list; its invocations share the elements.
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

// What blocks that touch may leave of a cell between them.
const ROUGH = 2e-3;

@compute @workgroup_size(INVOCATIONS)
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
    for (var place = local; place < WORKGROUP; place += INVOCATIONS) {
        saturate_element(slot, place);
    }
}

// What is at hand: most bricks have one tile, and what it says is fetched once for all of their elements.
var<private> held: u32 = NOTHING;
var<private> tile: Tile;
var<private> motion: Motion;

fn saturate_element(slot: u32, local: u32) {
    // Of each lane: velocity weighed by the shares, and their sum; whether a part is deep, or near.
    var sums: array<vec4<f32>, 4>;
    var deep: vec4<bool>;
    var near: vec4<bool>;
    // The same of parts that touch only, each as one.
    var beside: array<vec4<f32>, 4>;
    // One more than the number of a block that has a share or touches, 0 where there is none; whether another one does.
    var first_block: vec4<u32>;
    var several: vec4<bool>;
    for (var k = slot_first[slot]; k < slot_first[slot + 1u]; k++) {
        let number = slot_tiles[k];
        let mark = shares[number * WORKGROUP + local];
        if (mark == 0.0) {
            continue;
        }
        if (held != number) {
            held = number;
            tile = tiles[number];
            motion = motions[tile.block];
        }
        let cell = tile.cell + vec3<i32>(place_in_brick(local));
        let u = velocity_at(motion, centre_from(cell, motion.base, motion.fraction));
        let added = clamp(mark, 0.0, 1.0) * vec4(u, 1.0);
        let touching = select(0.0, 1.0, mark == TOUCHES) * vec4(u, 1.0);
        let here = vec4(tile.lane) == vec4(0u, 1u, 2u, 3u);
        for (var lane = 0u; lane < 4u; lane++) { // unroll
            sums[lane] += select(vec4(0.0), added, here[lane]);
            beside[lane] += select(vec4(0.0), touching, here[lane]);
        }
        deep = deep | (here & vec4(mark == DEEP));
        near = near | (here & vec4(mark < 0.0));
        let met = here & vec4(mark > 0.0 || mark == TOUCHES);
        several = several | (met & (first_block != vec4(0u)) & (first_block != vec4(tile.block + 1u)));
        first_block = select(first_block, vec4(tile.block + 1u), met);
    }
    for (var lane = 0u; lane < 4u; lane++) { // unroll
        if (lane < LANES_OF_ELEMENT) {
            let share = sums[lane].w;
            let some = share > 0.0;
            let joint = several[lane] && !deep[lane] && share > 1.0 - ROUGH;
            let first = (slot * PLANES * WORKGROUP + local) * LANES_OF_ELEMENT + lane;
            let stride = WORKGROUP * LANES_OF_ELEMENT;
            let solid = share + select(0.0, DEEP_SUM, deep[lane]) + select(0.0, JOINT_SUM, joint);
            let empty = select(0.0, NEAR, near[lane]);
            let all = sums[lane] + select(vec4(0.0), beside[lane], joint);
            let u = select(vec3(0.0), all.xyz / all.w, some);
            saturation[first] = select(empty, solid, some);
            saturation[first + stride] = u.x;
            saturation[first + 2u * stride] = u.y;
            saturation[first + 3u * stride] = u.z;
        }
    }
}
