// Gardner & Sitar 2018, eq. 10: the solid fraction of each cell, and how that solid moves, over all parts that share the
// cell, where one of them can reach. A workgroup is a lane of a brick with blocks; its invocations share the cells.
// needs tables, psm_planes, psm_storage, brick, joint_closure

override LANES_OF_ELEMENT: u32;

// Lanes of bricks: slot LANES_OF_ELEMENT + lane.
@group(0) @binding(0) var<storage, read> work: array<u32>;
@group(0) @binding(1) var<storage, read> tiles: array<Tile>;
@group(0) @binding(2) var<storage, read> motions: array<Motion>;
// Tiles of each lane of a brick with blocks in ascending order, and where they begin.
@group(0) @binding(3) var<storage, read> lane_first: array<u32>;
@group(0) @binding(4) var<storage, read> lane_tiles: array<u32>;
@group(0) @binding(5) var<storage, read> solid_fractions: array<f32>;

// Sums over the parts in one cell.
struct Sums {
    // Velocity weighed by the solid fractions, and their sum.
    solid: vec4<f32>,
    // The same of parts that touch only, each as one.
    touching: vec4<f32>,
    // Whether a part is interior, or near.
    interior: bool,
    near: bool,
    // One more than the number of a block that is in the cell or touches it, 0 where there is none; whether another one does.
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
    // Most lanes have one tile, and what it says is fetched once for all of their cells.
    let first = lane_tiles[select(0u, begin, begin < end)];
    let tile = tiles[first];
    let motion = motions[tile.block];
    for (var place = reach.x + local; place < reach.y; place += INVOCATIONS) {
        var sums: Sums;
        if (begin < end) {
            sums = with_part(sums, solid_fractions[first * WORKGROUP + place], tile, motion, place);
        }
        for (var k = begin + 1u; k < end; k++) {
            let number = lane_tiles[k];
            let mark = solid_fractions[number * WORKGROUP + place];
            if (mark != 0.0) {
                let other = tiles[number];
                sums = with_part(sums, mark, other, motions[other.block], place);
            }
        }
        write(lane, place, sums);
    }
}

fn reach_of_all(begin: u32, end: u32) -> vec2<u32> {
    var reach = vec2(WORKGROUP, 0u);
    for (var k = begin; k < end; k++) {
        let own = reach_of(tiles[lane_tiles[k]].inside);
        reach = vec2(min(reach.x, own.x), max(reach.y, own.y));
    }
    return reach;
}

fn with_part(before: Sums, mark: f32, tile: Tile, motion: Motion, place: u32) -> Sums {
    let cell = tile.cell + vec3<i32>(place_in_brick(place));
    let u = vec4(velocity_at(motion, centre_from(cell, motion.base, motion.fraction)), 1.0);
    let met = mark > 0.0 || mark == TOUCHES;
    let another = before.first_block != 0u && before.first_block != tile.block + 1u;
    return Sums(
        before.solid + clamp(mark, 0.0, 1.0) * u,
        before.touching + select(0.0, 1.0, mark == TOUCHES) * u,
        before.interior || mark == INTERIOR,
        before.near || mark < 0.0,
        select(before.first_block, tile.block + 1u, met),
        before.several || (met && another),
    );
}

fn write(lane: u32, place: u32, sums: Sums) {
    let fraction = sums.solid.w;
    let some = fraction > 0.0;
    let closure = select(0.0, joint_closure(fraction), sums.several && !sums.interior);
    let joint = closure > 0.0;
    let slot = lane / LANES_OF_ELEMENT;
    let at = place * LANES_OF_ELEMENT + lane % LANES_OF_ELEMENT;
    let all = sums.solid + closure * sums.touching;
    let u = select(vec3(0.0), all.xyz / all.w, some);
    write_psm(PLANE_SUM, slot, at, encode_sum(fraction, sums.near, sums.interior, joint));
    write_psm(PLANE_VELOCITY, slot, at, u.x);
    write_psm(PLANE_VELOCITY + 1u, slot, at, u.y);
    write_psm(PLANE_VELOCITY + 2u, slot, at, u.z);
}
