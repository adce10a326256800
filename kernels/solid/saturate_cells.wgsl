// Gardner & Sitar 2018, eq. 10: how much of each cell is solid, and how that solid moves, over all parts that share the
// cell, where one of them can reach. A workgroup is a lane of a saturated brick; its invocations share the cells.
// needs tables, brick

override LANES_OF_ELEMENT: u32;

// Lanes of bricks: slot LANES_OF_ELEMENT + lane.
@group(0) @binding(0) var<storage, read> work: array<u32>;
@group(0) @binding(1) var<storage, read> tiles: array<Tile>;
@group(0) @binding(2) var<storage, read> motions: array<Motion>;
// Tiles of each lane of a saturated brick in ascending order, and where they begin.
@group(0) @binding(3) var<storage, read> lane_first: array<u32>;
@group(0) @binding(4) var<storage, read> lane_tiles: array<u32>;
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
    let job = work[turn];
    if (job == NOTHING) {
        return;
    }
    let lane = job & ~WHOLE;
    let reach = select(reach_of_all(lane), vec2(0u, WORKGROUP), job >= WHOLE);
    for (var place = reach.x + local; place < reach.y; place += INVOCATIONS) {
        saturate_cell(lane, place);
    }
}

fn reach_of_all(lane: u32) -> vec2<u32> {
    var reach = vec2(WORKGROUP, 0u);
    for (var k = lane_first[lane]; k < lane_first[lane + 1u]; k++) {
        let own = reach_of(tiles[lane_tiles[k]].inside);
        reach = vec2(min(reach.x, own.x), max(reach.y, own.y));
    }
    return reach;
}

// What is at hand: most lanes have one tile, and what it says is fetched once for all of their cells.
var<private> held: u32 = NOTHING;
var<private> tile: Tile;
var<private> motion: Motion;

fn saturate_cell(lane: u32, local: u32) {
    // Velocity weighed by the shares, and their sum; whether a part is deep, or near.
    var sum: vec4<f32>;
    var deep = false;
    var near = false;
    // The same of parts that touch only, each as one.
    var beside: vec4<f32>;
    // One more than the number of a block that has a share or touches, 0 where there is none; whether another one does.
    var first_block = 0u;
    var several = false;
    for (var k = lane_first[lane]; k < lane_first[lane + 1u]; k++) {
        let number = lane_tiles[k];
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
        sum += clamp(mark, 0.0, 1.0) * vec4(u, 1.0);
        beside += select(0.0, 1.0, mark == TOUCHES) * vec4(u, 1.0);
        deep = deep || mark == DEEP;
        near = near || mark < 0.0;
        let met = mark > 0.0 || mark == TOUCHES;
        several = several || (met && first_block != 0u && first_block != tile.block + 1u);
        first_block = select(first_block, tile.block + 1u, met);
    }
    let some = sum.w > 0.0;
    let joint = several && !deep && sum.w > 1.0 - ROUGH;
    let slot = lane / LANES_OF_ELEMENT;
    let first = (slot * PLANES * WORKGROUP + local) * LANES_OF_ELEMENT + lane % LANES_OF_ELEMENT;
    let stride = WORKGROUP * LANES_OF_ELEMENT;
    let solid = sum.w + select(0.0, DEEP_SUM, deep) + select(0.0, JOINT_SUM, joint);
    let empty = select(0.0, NEAR, near);
    let all = sum + select(vec4(0.0), beside, joint);
    let u = select(vec3(0.0), all.xyz / all.w, some);
    saturation[first] = select(empty, solid, some);
    saturation[first + stride] = u.x;
    saturation[first + 2u * stride] = u.y;
    saturation[first + 3u * stride] = u.z;
}
