// Gardner & Sitar 2018, eqs. 11-12, with the minus that their text has and the equations lack: what the fluid does to
// one part in one cell, f = -e (a u_p + G), e being the effective fraction; a and G come from the fluid kernel.
// needs workgroup, tables, psm_planes, psm_storage, brick, joint_closure

override LANES_OF_ELEMENT: u32;

@group(0) @binding(0) var<storage, read> tiles: array<Tile>;
@group(0) @binding(1) var<storage, read> motions: array<Motion>;
@group(0) @binding(2) var<storage, read> solid_fractions: array<f32>;

struct SolidCell {
    // Its centre from that of the block.
    r: vec3<f32>,
    // Effective fraction.
    e: f32,
    // Force on the part.
    f: vec3<f32>,
    // Zero where there is no fluid.
    beta: f32,
}

// For effective fractions e above zero; other cells may hold any bits.
// `motion` is that of the tile's block.
fn solid_cell(tile: Tile, motion: Motion, e: f32, local: u32) -> SolidCell {
    let r = centre_from(tile.cell + vec3<i32>(place_in_brick(local)), motion.base, motion.fraction);
    let at = local * LANES_OF_ELEMENT + tile.lane;
    let a = read_psm(PLANE_A, tile.slot, at);
    let g = vec3(
        read_psm(PLANE_G, tile.slot, at),
        read_psm(PLANE_G + 1u, tile.slot, at),
        read_psm(PLANE_G + 2u, tile.slot, at),
    );
    // Blocks that meet slide on what is between them: none of it is due to how they differ.
    let mean = vec3(
        read_psm(PLANE_VELOCITY, tile.slot, at),
        read_psm(PLANE_VELOCITY + 1u, tile.slot, at),
        read_psm(PLANE_VELOCITY + 2u, tile.slot, at),
    );
    let own = velocity_at(motion, r);
    // decode_sum would give the same number, but drivers round `mix` otherwise behind it.
    let kept = read_psm(PLANE_SUM, tile.slot, at);
    let closure = joint_closure(kept - select(JOINT_SUM, FACING_SUM, kept >= FACING_SUM));
    let u = select(own, mix(own, mean, closure), kept >= JOINT_SUM && kept < SHARED_SUM);
    return SolidCell(r, e, -e * (a * u + g), read_psm(PLANE_BETA, tile.slot, at));
}
