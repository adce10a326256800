// Gardner & Sitar 2018, eq. 8-10: f* = f + (1 - B) fluid + B solid with B = e (tau - 1/2) / ((1 - e) + (tau - 1/2)),
// e the solid fraction of the cell, tau the relaxation time. The operator of the solid is linear in rho and in the
// solid's velocity, so that the force of each block in a cell follows from its own fraction and velocity.
// needs velocity, workgroup, $cells, $operator, $reals

// Nine planes of WORKGROUP elements for each brick: the sum of the fractions of all blocks, plus 8 in cells deep inside
// one, -1 in cells beside one; the mean velocity of the blocks; and for the forces beta = B / e, beta a and beta G. In
// cells beside one that are fluid the last five are 1, rho - 1 and the fluid's velocity.
@group(0) @binding(35) var<storage, read_write> saturation_planes: array<Reals>;

struct Saturation {
    // Sum over the blocks; more than 1 where they overlap.
    fraction: Real,
    velocity: Vector,
    near: Mask,
    beside: Mask,
    deep: Mask,
}

fn plane(slot: u32, n: u32, local: u32) -> u32 {
    return (slot * 9u + n) * WORKGROUP + local;
}

fn saturation_of(slot: u32, local: u32) -> Saturation {
    let kept = get_reals(saturation_planes[plane(slot, 0u, local)]);
    let deep = kept >= Real(8.0);
    let velocity = Vector(
        get_reals(saturation_planes[plane(slot, 1u, local)]),
        get_reals(saturation_planes[plane(slot, 2u, local)]),
        get_reals(saturation_planes[plane(slot, 3u, local)]),
    );
    let fraction = max(select(kept, kept - Real(8.0), deep), Real(0.0));
    return Saturation(fraction, velocity, kept != Real(0.0), kept < Real(0.0), deep);
}

// What the eddy viscosity of the next step sees: the solid's velocity in the solid.
fn mean_velocity(saturation: Saturation, u: Vector) -> Vector {
    let share = min(saturation.fraction, Real(1.0));
    return Vector(
        u.x + share * (saturation.velocity.x - u.x),
        u.y + share * (saturation.velocity.y - u.y),
        u.z + share * (saturation.velocity.z - u.z),
    );
}

// Solid rotation has an eddy viscosity by the formula, which it must not have.
fn outside_solids(saturation: Saturation, nu_t: Real) -> Real {
    return nu_t * (1.0 - min(saturation.fraction, Real(1.0)));
}

fn saturate(
    slot: u32,
    local: u32,
    cell: u32,
    saturation: Saturation,
    excess: Real,
    rho: Real,
    u: Vector,
    h: ptr<function, array<Real, 27>>,
    change: ptr<function, array<Real, 27>>,
) {
    let e = min(saturation.fraction, Real(1.0));
    // Divided by tau - 1/2, so that no compiler adds that to one and rounds it away.
    let weight = select(e / (1.0 + (1.0 - e) / excess), Real(1.0), saturation.deep);
    let v = saturation.velocity;
    var s = equilibrium(rho, v);
    for (var k = 1u; k < 27u; k++) { // unroll
        s[k] -= (*h)[k];
    }
    let factor = solid_operator(1.0 / (0.5 + excess), rho, u, h, saturation.deep, &s);
    for (var k = 1u; k < 27u; k++) { // unroll
        (*change)[k] += weight * (s[k] - (*change)[k]);
    }
    let fluid = (saturation.fraction > Real(0.0)) & !solid(cell);
    let beside = saturation.beside & !solid(cell);
    let beta = select(Real(0.0), weight / max(saturation.fraction, Real(1e-30)), fluid);
    let a = factor * rho;
    saturation_planes[plane(slot, 4u, local)] = put_reals(select(beta, Real(1.0), beside));
    saturation_planes[plane(slot, 5u, local)] = put_reals(select(beta * a, (*h)[0u], beside));
    saturation_planes[plane(slot, 6u, local)] = put_reals(select(beta * (s[1u] - a * v.x), u.x, beside));
    saturation_planes[plane(slot, 7u, local)] = put_reals(select(beta * (s[3u] - a * v.y), u.y, beside));
    saturation_planes[plane(slot, 8u, local)] = put_reals(select(beta * (s[9u] - a * v.z), u.z, beside));
}
