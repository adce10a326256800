// Ginzburg & d'Humieres 2003: in partially saturated cells and their neighbours the odd moments decide where
// the surface of a block lies; they relax at the rate with (1/s - 1/2)(tau - 1/2) = 1/10, floored.
// needs wall_rates, $psm

override N10: f32;
override N13: f32;
override N23: f32;
override N26: f32;

fn odd_rates(cell: u32, psm: PsmCell) -> OddRates {
    let others = wall_rates(cell);
    return OddRates(
        select(others.s10, Real(N10), psm.near),
        select(others.s13, Real(N13), psm.near),
        select(others.s23, Real(N23), psm.near),
        select(others.s26, Real(N26), psm.near),
    );
}
