// Laminar: one relaxation time, nu = (tau - 1/2) / 3.
// needs grid, $saturation

// tau - 1/2, which tau itself would round away at low viscosity.
override EXCESS: f32;

fn relaxation_excess(p: Place, cell: u32, saturation: Saturation) -> Real {
    return Real(EXCESS);
}
