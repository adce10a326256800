// The weight of the operator of Holdych with which a grid-aligned plane lies where it should, in steady shear, for every
// position in its cell, tau and rate s of the third odd moments (docs/src/theory/solids.md):
// B = 2 s e / (b + sqrt(b^2 + 12 (2 - s) (1 + x) s e)), b = s (1 + 2 x) - 3 (2 - s) e, x = (1 - e) / (tau - 1/2).
// needs $lanes

fn solid_weight(e: Real, tau_minus_half: Real, odd_rate: Real) -> Real {
    // Divided by tau - 1/2, so that no compiler adds that to one and rounds it away.
    let x = (1.0 - e) / tau_minus_half;
    let s = odd_rate;
    let b = s * (1.0 + 2.0 * x) - 3.0 * (2.0 - s) * e;
    let a = 6.0 * (2.0 - s) * (1.0 + x);
    let root = sqrt(b * b + 2.0 * a * s * e);
    // Two equal forms: each would lose digits by cancellation for the other sign of b.
    return select((root - b) / a, 2.0 * s * e / (root + b), b > Real(0.0));
}
