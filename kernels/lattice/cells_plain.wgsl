// Suga et al. 2015, section 3: fluid cells away from walls, the odd moments at the published rates.
// needs $lanes, velocity, grid

override S10: f32;
override S13: f32;
override S23: f32;
override S26: f32;

struct OddRates {
    s10: f32,
    s13: f32,
    s23: f32,
    s26: f32,
}

fn cell_class(p: Place) -> u32 {
    return 0u;
}

fn odd_rates(cell: u32) -> OddRates {
    return OddRates(S10, S13, S23, S26);
}

fn solid(cell: u32) -> Mask {
    return Mask(false);
}

fn clear_solid(cell: u32, h: ptr<function, array<Real, 27>>) {
}

fn still_in_solid(cell: u32, u: Vector) -> Vector {
    return u;
}

// Derivative along an axis from the values below, here and above; `face` is 0, 2 or 4 for x, y, z.
fn difference(cell: u32, face: u32, below: Real, here: Real, above: Real) -> Real {
    return 0.5 * (above - below);
}
