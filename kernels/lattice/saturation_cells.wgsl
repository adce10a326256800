// Gardner & Sitar 2018, eq. 8-10: f* = f + (1 - B) fluid + B solid with B = e (tau - 1/2) / ((1 - e) + (tau - 1/2)),
// e the solid fraction of the cell, tau the relaxation time. The operator of the solid is linear in rho and in the
// solid's velocity, so that the force of each block in a cell follows from its own fraction and velocity.
// needs velocity, moments, workgroup, psm_planes, tight, $cells, $operator, $reals

// See psm_planes.wgsl; WORKGROUP elements a plane.
@group(0) @binding(35) var<storage, read_write> saturation_planes: array<Reals>;

// Most of B in full cells where blocks meet each other or a wall: what is in a full cell it would reflect for ever, so
// that a block had the pressure of the day when its joint closed, and was tied to what it touches by the momentum between
// them. Water seeps through these, along the joint, and blocks slide on it: of the solid it feels a drag alone, so that its
// shear is that of its viscosity. As the joint opens they become cells as others are.
const SEEPS = 0.25;

struct Saturation {
    // Sum over the blocks; more than 1 where they overlap.
    fraction: Real,
    velocity: Vector,
    near: Mask,
    beside: Mask,
    deep: Mask,
    joint: Mask,
}

fn plane(slot: u32, n: u32, local: u32) -> u32 {
    return plane_element(slot, n, WORKGROUP, local);
}

fn saturation_of(slot: u32, local: u32) -> Saturation {
    let sum = decode_sum(get_reals(saturation_planes[plane(slot, PLANE_SUM, local)]));
    let velocity = Vector(
        get_reals(saturation_planes[plane(slot, PLANE_VELOCITY, local)]),
        get_reals(saturation_planes[plane(slot, PLANE_VELOCITY + 1u, local)]),
        get_reals(saturation_planes[plane(slot, PLANE_VELOCITY + 2u, local)]),
    );
    return Saturation(sum.fraction, velocity, sum.near, sum.beside, sum.deep, sum.joint);
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
    p: Place,
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
    let open = e / (1.0 + (1.0 - e) / excess);
    let tight = clamp((e - Real(1.0 - OPENS)) / (OPENS - ROUGH), Real(0.0), Real(1.0));
    let narrow = (tight > Real(0.0)) & !saturation.deep;
    var at_wall = Mask(false);
    // What the water loses to walls along them.
    var lost = Vector(Real(0.0), Real(0.0), Real(0.0));
    for (var face = 0u; face < 6u; face++) { // unroll
        let here = narrow & wall_at(p, cell, face);
        at_wall = at_wall | here;
        lost = lost_to_wall(face, here, h, lost);
    }
    let seeps = select(Real(0.0), tight, saturation.joint | at_wall);
    let closed = open + seeps * (min(open, Real(SEEPS)) - open);
    let weight = select(closed, Real(1.0), saturation.deep);
    let v = saturation.velocity;
    var s = equilibrium(rho, v);
    for (var k = 1u; k < 27u; k++) { // unroll
        s[k] -= (*h)[k];
    }
    let factor = solid_operator(1.0 / (0.5 + excess), rho, u, h, saturation.deep, &s);
    let higher = (1.0 - seeps) * weight;
    for (var k = 1u; k < 27u; k++) { // unroll
        let part = select(higher, weight, Mask(k == 1u || k == 3u || k == 9u));
        (*change)[k] += part * (s[k] - (*change)[k]);
    }
    let fluid = (saturation.fraction > Real(0.0)) & !solid(cell);
    let beside = saturation.beside & !solid(cell);
    let beta = select(Real(0.0), weight / max(saturation.fraction, Real(1e-30)), fluid);
    let a = factor * rho;
    let each = 2.0 * tight / max(saturation.fraction, Real(1.0));
    saturation_planes[plane(slot, PLANE_BETA, local)] = put_reals(select(beta, Real(1.0), beside));
    saturation_planes[plane(slot, PLANE_A, local)] = put_reals(select(beta * a, (*h)[0u], beside));
    saturation_planes[plane(slot, PLANE_G, local)] = put_reals(select(beta * (s[1u] - a * v.x) + each * lost.x, u.x, beside));
    saturation_planes[plane(slot, PLANE_G + 1u, local)] = put_reals(select(beta * (s[3u] - a * v.y) + each * lost.y, u.y, beside));
    saturation_planes[plane(slot, PLANE_G + 2u, local)] = put_reals(select(beta * (s[9u] - a * v.z) + each * lost.z, u.z, beside));
}

// Adds half the momentum that comes back from a wall along it, the sum of f c over the directions that leave the wall, where
// `here`. A full cell at a wall has the friction of the lattice there, which belongs to nobody: the block has it all, and
// the less of it the more its joint is open.
fn lost_to_wall(face: u32, here: Mask, h: ptr<function, array<Real, 27>>, before: Vector) -> Vector {
    let way = select(Real(0.5), Real(-0.5), Mask(face % 2u == 1u));
    let zero = Real(0.0);
    var found: Vector;
    switch face / 2u {
        case 0u: {
            found = Vector(zero, leaving((*h)[3u], (*h)[4u], (*h)[5u], way), leaving((*h)[9u], (*h)[10u], (*h)[11u], way));
        }
        case 1u: {
            found = Vector(leaving((*h)[1u], (*h)[4u], (*h)[7u], way), zero, leaving((*h)[9u], (*h)[12u], (*h)[15u], way));
        }
        default: {
            found = Vector(leaving((*h)[1u], (*h)[10u], (*h)[19u], way), leaving((*h)[3u], (*h)[12u], (*h)[21u], way), zero);
        }
    }
    return Vector(
        before.x + select(zero, found.x, here),
        before.y + select(zero, found.y, here),
        before.z + select(zero, found.z, here),
    );
}

// The sum of f c_t over the directions with c_n = 1 or -1, from those of f c_t, f c_t c_n and f c_t (c_n^2 - 1/3).
fn leaving(first: Real, second: Real, third: Real, way: Real) -> Real {
    return 0.5 * (third + first * THIRD) + way * second;
}
