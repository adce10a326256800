// Noble & Torczynski 1998, eq. 5; Gardner & Sitar 2018, eq. 10, with the relaxation time in place of its inverse:
// B = e (tau - 1/2) / ((1 - e) + (tau - 1/2)).
// needs $lanes

fn solid_weight(e: Real, tau_minus_half: Real, odd_rate: Real) -> Real {
    // Divided by tau - 1/2, so that no compiler adds that to one and rounds it away.
    return e / (1.0 + (1.0 - e) / tau_minus_half);
}
