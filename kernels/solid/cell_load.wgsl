// Gardner & Sitar 2018, eqs. 11-12, with the minus that their text has and the equations lack: what the fluid does to
// one part, f = -e (a u_p + G) and f (x) r in each cell, e the solid fraction, a and G from the fluid kernel. And the
// fluid that it holds, B = e beta, and the fluid that it does not, e - B.
// needs workgroup, tables, brick, wrench

override LANES_OF_ELEMENT: u32;

@group(0) @binding(0) var<storage, read> tiles: array<Tile>;
@group(0) @binding(1) var<storage, read> motions: array<Motion>;
@group(0) @binding(2) var<storage, read> shares: array<f32>;
@group(0) @binding(3) var<storage, read> saturation: array<f32>;
// Tiles before each block, and all.
@group(0) @binding(4) var<storage, read> block_first: array<u32>;

fn add_cell(tile: Tile, number: u32, local: u32) {
    let mark = shares[number * WORKGROUP + local];
    // What the cell holds otherwise need not be a number.
    if (mark <= 0.0) {
        return;
    }
    let e = min(mark, 1.0);
    let motion = motions[tile.block];
    let r = centre_from(tile.cell + vec3<i32>(place_in_brick(local)), motion.base, motion.fraction);
    let first = (tile.slot * PLANES * WORKGROUP + local) * LANES_OF_ELEMENT + tile.lane;
    let stride = WORKGROUP * LANES_OF_ELEMENT;
    let beta = saturation[first + 4u * stride];
    let a = saturation[first + 5u * stride];
    let g = vec3(
        saturation[first + 6u * stride],
        saturation[first + 7u * stride],
        saturation[first + 8u * stride],
    );
    let f = -e * (a * velocity_at(motion, r) + g);
    let held = e * beta;
    let freed = select(0.0, e - held, beta > 0.0);
    for (var i = 0u; i < 3u; i++) { // unroll
        wrench[i] += f[i];
        for (var j = 0u; j < 3u; j++) { // unroll
            wrench[3u + 3u * i + j] += f[i] * r[j];
        }
        wrench[14u + i] += held * r[i];
        wrench[17u + i] += freed * r[i];
    }
    wrench[12] += held;
    wrench[13] += freed;
}

fn tile_count() -> u32 {
    return min(TILES, block_first[arrayLength(&block_first) - 1u]);
}
