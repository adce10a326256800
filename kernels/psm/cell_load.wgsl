// Gardner & Sitar 2018, eqs. 11-12: force f and moment f (x) r of one cell, the volume of fluid that the solid entrains,
// B = e beta, and the volume that it displaces in addition, the solid fraction less B.
// needs solid_cell, wrench

@group(0) @binding(3) var<storage, read> effective_fractions: array<vec2<f32>>;
// Segments, consecutive tiles of one block: the first tile, and above SEGMENT_SHIFT bits the number of tiles after it.
@group(0) @binding(4) var<storage, read> segments: array<u32>;

const SEGMENT_SHIFT = 28u;

fn add_cell(tile: Tile, motion: Motion, number: u32, local: u32) {
    let effective = effective_fractions[number * WORKGROUP + local].x;
    if (effective <= 0.0) {
        return;
    }
    let solid = clamp(solid_fractions[number * WORKGROUP + local], 0.0, 1.0);
    let cell = solid_cell(tile, motion, effective, local);
    let entrained = cell.e * cell.beta;
    let displaced = select(0.0, solid - entrained, cell.beta > 0.0);
    for (var i = 0u; i < 3u; i++) { // unroll
        wrench[i] += cell.f[i];
        for (var j = 0u; j < 3u; j++) { // unroll
            wrench[3u + 3u * i + j] += cell.f[i] * cell.r[j];
        }
        wrench[14u + i] += entrained * cell.r[i];
        wrench[17u + i] += displaced * cell.r[i];
    }
    wrench[12] += entrained;
    wrench[13] += displaced;
}

fn segment_at(index: u32) -> u32 {
    if (index < arrayLength(&segments)) {
        return segments[index];
    }
    return NOTHING;
}

// Adds every `stride`-th cell of each tile of a segment, starting at `local`.
fn add_segment(segment: u32, local: u32, stride: u32) {
    let first = segment & ((1u << SEGMENT_SHIFT) - 1u);
    for (var number = first; number <= first + (segment >> SEGMENT_SHIFT); number++) {
        let tile = tiles[number];
        let motion = motions[tile.block];
        let reach = reach_of(tile.inside);
        for (var l = reach.x + local; l < reach.y; l += stride) {
            add_cell(tile, motion, number, l);
        }
    }
}
