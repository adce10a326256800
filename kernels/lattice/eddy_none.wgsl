// Laminar: one relaxation time, nu = (tau - 1/2) / 3.
// needs grid, $psm

// tau - 1/2, which tau itself would round away at low viscosity.
override TAU_MINUS_HALF: f32;

fn tau_minus_half(p: Place, cell: u32, psm: PsmCell) -> Real {
    return Real(TAU_MINUS_HALF);
}
