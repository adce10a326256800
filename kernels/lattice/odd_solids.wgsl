// Ginzburg & d'Humieres 2003: in partially saturated cells and their neighbours the odd moments decide where
// the surface of a block lies; they relax at the rate with (1/s - 1/2)(tau - 1/2) = 1/10, floored.
// needs wall_rates, $saturation

override N10: f32;
override N13: f32;
override N23: f32;
override N26: f32;

fn odd_rates(cell: u32, saturation: Saturation) -> OddRates {
    let others = wall_rates(cell);
    return OddRates(
        select(others.s10, Real(N10), saturation.near),
        select(others.s13, Real(N13), saturation.near),
        select(others.s23, Real(N23), saturation.near),
        select(others.s26, Real(N26), saturation.near),
    );
}
