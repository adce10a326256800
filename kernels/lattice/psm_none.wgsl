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

fn apply_solid(
    p: Place,
    slot: u32,
    local: u32,
    cell: u32,
    psm: PsmCell,
    tau_minus_half: Real,
    rho: Real,
    u: Vector,
    h: ptr<function, array<Real, 27>>,
    change: ptr<function, array<Real, 27>>,
) {
}
