// Gardner & Sitar 2018, eqs. 11-12, with the minus sign that is in their text but not in the equations: the force of
// the fluid on one part in one cell, f = -e (a u_p + G), with the effective fraction e, and a and G from the fluid kernel.
// needs workgroup, tables, psm_planes, psm_storage, brick, joint_closure

override LANES_OF_ELEMENT: u32;

@group(0) @binding(0) var<storage, read> tiles: array<Tile>;
@group(0) @binding(1) var<storage, read> motions: array<Motion>;
@group(0) @binding(2) var<storage, read> solid_fractions: array<f32>;

struct SolidCell {
    // Centre of the cell from the centroid of the block.
    r: vec3<f32>,
    // Effective fraction.
    e: f32,
    // Force on the part.
    f: vec3<f32>,
    // B / sum; zero without fluid.
    beta: f32,
}

// Only for effective fractions e above zero; other cells may contain any bits. `motion` is that of the tile's block.
fn solid_cell(tile: Tile, motion: Motion, e: f32, local: u32) -> SolidCell {
    let r = centre_from(tile.cell + vec3<i32>(place_in_brick(local)), motion.base, motion.fraction);
    let at = local * LANES_OF_ELEMENT + tile.lane;
    let a = read_psm(PLANE_A, tile.slot, at);
    let g = vec3(
        read_psm(PLANE_G, tile.slot, at),
        read_psm(PLANE_G + 1u, tile.slot, at),
        read_psm(PLANE_G + 2u, tile.slot, at),
    );
    // In a closing joint, the mean velocity of the blocks replaces their own, so that sliding causes no force.
    let mean = vec3(
        read_psm(PLANE_VELOCITY, tile.slot, at),
        read_psm(PLANE_VELOCITY + 1u, tile.slot, at),
        read_psm(PLANE_VELOCITY + 2u, tile.slot, at),
    );
    let own = velocity_at(motion, r);
    // decode_sum would yield the same number, but after it drivers round `mix` differently.
    let kept = read_psm(PLANE_SUM, tile.slot, at);
    let closure = joint_closure(kept - select(JOINT_SUM, FACING_SUM, kept >= FACING_SUM));
    let u = select(own, mix(own, mean, closure), kept >= JOINT_SUM && kept < SHARED_SUM);
    return SolidCell(r, e, -e * (a * u + g), read_psm(PLANE_BETA, tile.slot, at));
}
