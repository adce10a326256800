// Gardner & Sitar 2018, eqs. 11-12: force f and moment f (x) r of one cell, the fluid that the solid entrains there,
// B = e beta, and the fluid that it displaces beyond that, the solid fraction less B.
// needs solid_cell, wrench

@group(0) @binding(3) var<storage, read> effective_fractions: array<vec2<f32>>;
// Tiles before each block, and all.
@group(0) @binding(4) var<storage, read> block_first: array<u32>;

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

fn tile_count() -> u32 {
    return block_first[arrayLength(&block_first) - 1u];
}
