// No block is in the fluid.
// needs velocity, grid, $lanes

struct PsmCell {
    unused: u32,
}

fn psm_cell(slot: u32, local: u32) -> PsmCell {
    return PsmCell(0u);
}

fn mean_velocity(psm: PsmCell, u: Vector) -> Vector {
    return u;
}

fn outside_solids(psm: PsmCell, nu_t: Real) -> Real {
    return nu_t;
}

struct SolidWeights {
    unused: u32,
}

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
    return SolidWeights(0u);
}

fn blend_with_solid(weights: SolidWeights, solid: ptr<function, array<Real, 27>>, change: ptr<function, array<Real, 27>>) {
}

// The velocity in the middle of the step.
fn velocity_at_middle(
    weights: SolidWeights,
    rho: Real,
    u: Vector,
    by_half_force: Vector,
    solid: ptr<function, array<Real, 27>>,
) -> Vector {
    return u;
}
