// Bhatnagar, Gross & Krook 1954: every moment relaxes at the one rate 1/tau.
// needs $cell_flags, $psm

// Rate of the moments 120 + 102, and likewise for y and z.
fn third_order_rate(cell: u32, psm: PsmCell, shear_rate: Real) -> Real {
    return shear_rate;
}

fn relax(cell: u32, psm: PsmCell, shear_rate: Real, d: ptr<function, array<Real, 27>>, h: ptr<function, array<Real, 27>>) {
    for (var k = 2u; k < 27u; k++) { // unroll
        if (k != 3u && k != 9u) {
            (*h)[k] += shear_rate * (*d)[k];
        }
    }
}
