// Han, Ooka & Kikumoto 2021, Fluid Dyn. Res. 53:045506, for faces of blocks. Of the tangential momentum P that arrives in a full
// cell under a grid-aligned face, P less the stress of the law of the wall returns: sum over c_n = 1 of f* c_t = P - stress. The
// other directions leave with the velocity of the block. A cell that a face cuts exchanges no tangential momentum. The body force F
// that the pressure balances in fluid at rest adds F/6 to what returns, and F in cells that a face cuts.
// needs velocity, moments, psm_planes, psm_storage, workgroup, $reals, $balanced_force

// Codes of the cells of each brick that blocks reach: 1 to 6 under a face x-, x+, y-, y+, z-, z+; 7 to 12 cut by a face z+, z-,
// y+, y-, x+, x-; 13 cut by a sloping face; 14 full, at one; 0 elsewhere.
@group(0) @binding(39) var<storage, read> face_codes: array<Reals>;

// Modifies the moments s of the change by the solid, given the moments h before it; returns the share of the law in a full cell.
fn apply_wall_stress(p: Place, slot: u32, local: u32, rho: Real, v: Vector, h: ptr<function, array<Real, 27>>, s: ptr<function, array<Real, 27>>) -> Real {
    let code = unpack_reals(face_codes[slot * WORKGROUP + local]);
    let acts = (code > Real(0.0)) & (code < Real(12.5));
    let slopes = code > Real(13.5);
    if (!mask_any(acts | slopes)) {
        return Real(0.0);
    }
    // In other cells the planes still hold the values of the previous step.
    let share = select(Real(0.0), unpack_reals(read_psm(PLANE_SHARE, slot, local)), acts | slopes);
    if (!mask_any(acts)) {
        return share;
    }
    let sixths = array<Real, 3>(v.x * (1.0 / 6.0), v.y * (1.0 / 6.0), v.z * (1.0 / 6.0));
    let rest = balanced_force(p);
    let at_rest = array<Real, 3>(rest.x, rest.y, rest.z);
    let stride = array<u32, 3>(1u, 3u, 9u);
    for (var along = 0u; along < 3u; along++) { // unroll
        let t = stride[along];
        let stress = select(Real(0.0), unpack_reals(read_psm(PLANE_STRESS + along, slot, local)), acts);
        let sixth = rho * sixths[along];
        for (var other = 1u; other < 3u; other++) { // unroll
            let normal = (along + other) % 3u;
            let n = stride[normal];
            let up = code == Real(2.0 + 2.0 * f32(normal));
            let full = up | (code == Real(1.0 + 2.0 * f32(normal)));
            let part = select(Real(0.0), share, full);
            let sign = select(Real(-1.0), Real(1.0), up);
            let returns = 0.5 * ((*h)[t + 2u * n] + THIRD * (*h)[t] - sign * (*h)[t + n]) - stress + (1.0 / 6.0) * at_rest[along];
            let first = returns + 5.0 * sixth;
            (*s)[t + n] += part * (sign * (returns - sixth) - (*h)[t + n] - (*s)[t + n]);
            (*s)[t + 2u * n] += part * (returns + sixth - THIRD * first - (*h)[t + 2u * n] - (*s)[t + 2u * n]);
            let change = select(at_rest[along], first - (*h)[t], full);
            (*s)[t] += select(part, share, (code == Real(12.0 - 2.0 * f32(normal))) | (code == Real(11.0 - 2.0 * f32(normal)))) * (change - (*s)[t]);
        }
    }
    return select(Real(0.0), share, (acts & (code < Real(6.5))) | slopes);
}

// Whether the law acts on sloping faces.
override SLOPING: bool;

// The velocity of the solid for the change of a cell. A solid whose face slopes has the tangential velocity of the fluid, so that
// the momentum changes along the normal alone, and along the face by the balanced force.
fn sliding_velocity(p: Place, slot: u32, local: u32, rho: Real, v: Vector, h: ptr<function, array<Real, 27>>) -> Vector {
    if (!SLOPING) {
        return v;
    }
    let code = unpack_reals(face_codes[slot * WORKGROUP + local]);
    let slides = (code > Real(12.5)) & (code < Real(13.5));
    if (!mask_any(slides)) {
        return v;
    }
    let share = select(Real(0.0), unpack_reals(read_psm(PLANE_SHARE, slot, local)), slides);
    let n = Vector(
        unpack_reals(read_psm(PLANE_STRESS, slot, local)),
        unpack_reals(read_psm(PLANE_STRESS + 1u, slot, local)),
        unpack_reals(read_psm(PLANE_STRESS + 2u, slot, local)),
    );
    let rest = balanced_force(p);
    let u = Vector(
        ((*h)[1u] + 0.5 * rest.x) / rho - v.x,
        ((*h)[3u] + 0.5 * rest.y) / rho - v.y,
        ((*h)[9u] + 0.5 * rest.z) / rho - v.z,
    );
    let away = n.x * u.x + n.y * u.y + n.z * u.z;
    // In other cells the planes hold other values, and may hold NaN.
    return Vector(
        v.x + select(Real(0.0), share * (u.x - away * n.x), slides),
        v.y + select(Real(0.0), share * (u.y - away * n.y), slides),
        v.z + select(Real(0.0), share * (u.z - away * n.z), slides),
    );
}

// The weight of the solid in a cell, at least the share of the law.
fn with_law(weight: Real, share_of_law: Real) -> Real {
    return max(weight, share_of_law);
}
