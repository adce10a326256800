// Gardner & Sitar 2018, eq. 8, for solids at rest: the fraction of a cell that they fill, in the bricks with a surface.
// needs velocity, grid, $lanes, $bricks, $reals, $balanced_force, workgroup

// Slot of each brick in `surface_fractions`, from 1; 0 without a surface.
@group(0) @binding(37) var<storage, read> surface_slots: array<u32>;
// SURFACE_PLANES times WORKGROUP elements per brick: the fraction, 0 to 1, and -1 next to a cell that solids fill in part; for a wall
// model also its share and the normal of the surface, in cells that slide.
@group(0) @binding(38) var<storage, read> surface_fractions: array<Reals>;

override SURFACE_PLANES: u32;

struct Surface {
    fraction: Real,
    near: Mask,
}

fn surface_at(index: u32, local: u32) -> Surface {
    let slot = surface_slots[brick_of(index)];
    if (slot == 0u) {
        return Surface(Real(0.0), Mask(false));
    }
    let kept = surface_plane(slot, 0u, local);
    return Surface(max(kept, Real(0.0)), kept != Real(0.0));
}

fn surface_plane(slot: u32, plane: u32, local: u32) -> Real {
    return unpack_reals(surface_fractions[((slot - 1u) * SURFACE_PLANES + plane) * WORKGROUP + local]);
}

// The velocity of the solid for the change of a cell. A solid at rest whose surface slopes has the tangential velocity of the fluid, so
// that the momentum changes along the normal alone, and along the surface by the balanced force. `alone`: the cell has no block.
fn sliding_on_surface(p: Place, index: u32, local: u32, alone: Mask, rho: Real, v: Vector, h: ptr<function, array<Real, 27>>) -> Vector {
    let slot = surface_slots[brick_of(index)];
    if (SURFACE_PLANES == 1u || slot == 0u) {
        return v;
    }
    let share = select(Real(0.0), surface_plane(slot, 1u, local), alone);
    if (!mask_any(share > Real(0.0))) {
        return v;
    }
    let n = Vector(surface_plane(slot, 2u, local), surface_plane(slot, 3u, local), surface_plane(slot, 4u, local));
    let rest = balanced_force(p);
    let u = Vector(
        ((*h)[1u] + 0.5 * rest.x) / rho,
        ((*h)[3u] + 0.5 * rest.y) / rho,
        ((*h)[9u] + 0.5 * rest.z) / rho,
    );
    let away = n.x * u.x + n.y * u.y + n.z * u.z;
    return Vector(v.x + share * (u.x - away * n.x), v.y + share * (u.y - away * n.y), v.z + share * (u.z - away * n.z));
}
