// Gardner & Sitar 2018, eq. 8, for solids at rest: the fraction of a cell that they fill, in the bricks with a surface.
// needs $lanes, $bricks, $reals, workgroup

// Slot of each brick in `surface_fractions`, from 1; 0 without a surface.
@group(0) @binding(37) var<storage, read> surface_slots: array<u32>;
// WORKGROUP elements per brick: 0 to 1, and -1 next to a cell that solids fill in part.
@group(0) @binding(38) var<storage, read> surface_fractions: array<Reals>;

struct Surface {
    fraction: Real,
    near: Mask,
}

fn surface_at(index: u32, local: u32) -> Surface {
    let slot = surface_slots[brick_of(index)];
    if (slot == 0u) {
        return Surface(Real(0.0), Mask(false));
    }
    let kept = unpack_reals(surface_fractions[(slot - 1u) * WORKGROUP + local]);
    return Surface(max(kept, Real(0.0)), kept != Real(0.0));
}
