// Laminar: one relaxation time, nu = (tau - 1/2) / 3.
// needs grid, $saturation

override TAU: f32;

fn relaxation_time(p: Place, cell: u32, saturation: Saturation) -> Real {
    return Real(TAU);
}
