// Gardner & Sitar 2018, eq. 10: the fraction that determines the weight of the solid in each cell that parts can reach, and the
// velocity of that solid, over all parts that share the cell. A workgroup processes a lane of a brick with blocks; its
// invocations share the cells.
// needs tables, psm_planes, psm_storage, brick, joint_closure

override LANES_OF_ELEMENT: u32;

// Lanes of bricks: slot * LANES_OF_ELEMENT + lane.
@group(0) @binding(0) var<storage, read> work: array<u32>;
@group(0) @binding(1) var<storage, read> tiles: array<Tile>;
@group(0) @binding(2) var<storage, read> motions: array<Motion>;
// Tiles of each lane in ascending order (lane_tiles), and the index of the first tile of each lane (lane_first).
@group(0) @binding(3) var<storage, read> lane_first: array<u32>;
@group(0) @binding(4) var<storage, read> lane_tiles: array<u32>;
@group(0) @binding(5) var<storage, read> solid_fractions: array<f32>;
@group(0) @binding(6) var<storage, read> effective_fractions: array<vec2<f32>>;

// Sums over the parts in one cell.
struct Sums {
    // Velocity weighted by the effective fractions, and the sum of these fractions.
    solid: vec4<f32>,
    // The same for parts that only touch the cell, each with the weight one.
    touching: vec4<f32>,
    // Sum and maximum of the solid fractions, largest effective fraction, and number of parts with an effective fraction.
    fraction: f32,
    most: f32,
    largest: f32,
    parts: u32,
    // Whether a part has the mark INTERIOR, and whether one has NEAR or TOUCHES.
    interior: bool,
    near: bool,
    // One plus the index of a block that is in the cell or touches it, 0 without one; whether another block does too.
    first_block: u32,
    several: bool,
}

@compute @workgroup_size(INVOCATIONS)
fn combine_parts(
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
    let lane = job & ~WHOLE;
    let begin = lane_first[lane];
    let end = lane_first[lane + 1u];
    let reach = select(reach_of_all(begin, end), vec2(0u, WORKGROUP), job >= WHOLE);
    // Most lanes have one tile, whose data is fetched once for all cells.
    let first = lane_tiles[select(0u, begin, begin < end)];
    let tile = tiles[first];
    let motion = motions[tile.block];
    for (var place = reach.x + local; place < reach.y; place += INVOCATIONS) {
        var sums: Sums;
        if (begin < end) {
            sums = with_part(sums, first, tile, motion, place);
        }
        for (var k = begin + 1u; k < end; k++) {
            let number = lane_tiles[k];
            if (solid_fractions[number * WORKGROUP + place] != 0.0) {
                let other = tiles[number];
                sums = with_part(sums, number, other, motions[other.block], place);
            }
        }
        if (sums.parts > 1u) {
            sums.largest = 0.0;
            for (var k = begin; k < end; k++) {
                sums.largest = max(sums.largest, beside_others(lane_tiles[k] * WORKGROUP + place, sums.fraction));
            }
        }
        write(lane, place, sums);
    }
}

// Effective fraction of a part if all parts together fill `all` of the cell: that of the part alone, reduced as other parts
// fill the volume by which the part would grow if it extended across the cell beyond one of its edges. Flush parts yield the
// same fraction as a single part.
fn beside_others(at: u32, all: f32) -> f32 {
    let solid = clamp(solid_fractions[at], 0.0, 1.0);
    let effective = effective_fractions[at];
    // Two planes at a right angle leave the fractions `effective.y` and `other` of the cell.
    let other = solid / max(effective.y, 1e-9);
    let longer = min(other, effective.y) - solid;
    let free = clamp(1.0 - (all - solid) / max(longer, 1e-9), 0.0, 1.0);
    return effective.y + free * (effective.x - effective.y);
}

fn reach_of_all(begin: u32, end: u32) -> vec2<u32> {
    var reach = vec2(WORKGROUP, 0u);
    for (var k = begin; k < end; k++) {
        let own = reach_of(tiles[lane_tiles[k]].inside);
        reach = vec2(min(reach.x, own.x), max(reach.y, own.y));
    }
    return reach;
}

fn with_part(before: Sums, number: u32, tile: Tile, motion: Motion, place: u32) -> Sums {
    let mark = solid_fractions[number * WORKGROUP + place];
    let effective = effective_fractions[number * WORKGROUP + place].x;
    let cell = tile.cell + vec3<i32>(place_in_brick(place));
    let u = vec4(velocity_at(motion, centre_from(cell, motion.base, motion.fraction)), 1.0);
    let met = mark > 0.0 || mark == TOUCHES;
    let another = before.first_block != 0u && before.first_block != tile.block + 1u;
    return Sums(
        before.solid + effective * u,
        before.touching + select(0.0, 1.0, mark == TOUCHES) * u,
        before.fraction + clamp(mark, 0.0, 1.0),
        max(before.most, mark),
        max(before.largest, effective),
        before.parts + select(0u, 1u, effective > 0.0),
        before.interior || mark == INTERIOR,
        before.near || mark < 0.0,
        select(before.first_block, tile.block + 1u, met),
        before.several || (met && another),
    );
}

fn write(lane: u32, place: u32, sums: Sums) {
    let shares = sums.solid.w;
    let some = shares > 0.0;
    let several = sums.several && !sums.interior;
    let closure = select(0.0, joint_closure(sums.fraction), several);
    let joint = closure > 0.0;
    let facing = sums.fraction - sums.most < TOUCHING_GAP;
    let slot = lane / LANES_OF_ELEMENT;
    let at = place * LANES_OF_ELEMENT + lane % LANES_OF_ELEMENT;
    let all = sums.solid + closure * sums.touching;
    let u = select(vec3(0.0), all.xyz / all.w, some);
    write_psm(PLANE_SUM, slot, at, encode_sum(shares, sums.near, sums.interior, joint, facing, several));
    write_psm(PLANE_FRACTION, slot, at, min(max(sums.fraction, sums.largest), 1.0));
    write_psm(PLANE_VELOCITY, slot, at, u.x);
    write_psm(PLANE_VELOCITY + 1u, slot, at, u.y);
    write_psm(PLANE_VELOCITY + 2u, slot, at, u.z);
}
