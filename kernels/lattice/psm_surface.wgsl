// Gardner & Sitar 2018, eq. 8-10: f* = f + (1 - B) fluid + B solid in cells that solids at rest fill in part. Full cells reflect
// populations; with the exact weight, a grid-aligned plane then lies where it should.
// needs velocity, moments, surface_fraction, solid_weights, $operator, $weight

struct PsmCell {
    fraction: Real,
    near: Mask,
}

fn psm_cell(index: u32, local: u32) -> PsmCell {
    let surface = surface_at(index, local);
    return PsmCell(surface.fraction, surface.near);
}

// For the eddy viscosity of the next step: the solid is at rest.
fn mean_velocity(psm: PsmCell, u: Vector) -> Vector {
    let open = 1.0 - psm.fraction;
    return Vector(open * u.x, open * u.y, open * u.z);
}

fn outside_solids(psm: PsmCell, nu_t: Real) -> Real {
    return nu_t * (1.0 - psm.fraction);
}

// Runs before the collision: replaces the moments h by the change by the solid alone.
fn collide_with_solid(
    p: Place,
    slot: u32,
    local: u32,
    cell: u32,
    psm: PsmCell,
    tau_minus_half: Real,
    odd_rate: Real,
    rho: Real,
    u: Vector,
    h: ptr<function, array<Real, 27>>,
) -> SolidWeights {
    let zero = Real(0.0);
    var s = equilibrium(rho, sliding_on_surface(p, slot, local, psm.fraction > zero, rho, Vector(zero, zero, zero), h));
    for (var k = 1u; k < 27u; k++) { // unroll
        s[k] -= (*h)[k];
    }
    _ = solid_operator(1.0 / (0.5 + tau_minus_half), rho, u, h, Mask(false), Real(0.0), &s);
    *h = s;
    let open = solid_weight(psm.fraction, tau_minus_half, odd_rate);
    let closure = closure_of(psm.fraction);
    return SolidWeights(max(open, closure * LEAST_WEIGHT), max(open, closure * JOINT_DAMPING));
}

// The velocity of the statistics: as the fields show it, without the change by the solid.
fn velocity_at_middle(
    weights: SolidWeights,
    rho: Real,
    u: Vector,
    by_half_force: Vector,
    solid: ptr<function, array<Real, 27>>,
) -> Vector {
    return u;
}
