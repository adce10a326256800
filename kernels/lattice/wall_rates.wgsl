// Ginzburg & d'Humieres 2003, Phys. Rev. E 68:066614: next to walls the odd moments relax at the rate
// that puts half-way bounce-back exactly half a cell away, (1/s - 1/2)(tau - 1/2) = 3/16, floored.
// needs $lanes, $cell_flags

override S10: f32;
override S13: f32;
override S23: f32;
override S26: f32;
override W10: f32;
override W13: f32;
override W23: f32;
override W26: f32;

struct OddRates {
    s10: Real,
    s13: Real,
    s23: Real,
    s26: Real,
}

fn wall_rates(cell: u32) -> OddRates {
    let wall = next_to_wall(cell);
    return OddRates(
        select(Real(S10), Real(W10), wall),
        select(Real(S13), Real(W13), wall),
        select(Real(S23), Real(W23), wall),
        select(Real(S26), Real(W26), wall),
    );
}
