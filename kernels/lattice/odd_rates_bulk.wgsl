// Suga et al. 2015, section 3: away from walls and blocks the odd moments relax at the published rates.
// needs $lanes, $psm

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

fn odd_rates(cell: u32, psm: PsmCell) -> OddRates {
    return OddRates(S10, S13, S23, S26);
}
