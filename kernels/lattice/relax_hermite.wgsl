// Suga et al. 2015, eq. 6-10: their moments made orthogonal with the lattice weights, which makes them
// the tensor Hermite moments up to sums and differences.
// needs $cell_flags, $odd_rates

override S4: f32;
override S16: f32;
override S17: f32;
override S18: f32;
override S20: f32;

// Rate of the moments 120 + 102, and likewise for y and z.
fn third_order_rate(cell: u32, psm: PsmCell, shear_rate: Real) -> Real {
    return Real(odd_rates(cell, psm).s10);
}

fn relax(cell: u32, psm: PsmCell, shear_rate: Real, d: ptr<function, array<Real, 27>>, h: ptr<function, array<Real, 27>>) {
    let odd = odd_rates(cell, psm);

    // 200, 020, 002: trace at S4, deviators at the shear rate; 110, 101, 011 too.
    let trace2 = ((*d)[2u] + (*d)[6u] + (*d)[18u]) * (1.0 / 3.0);
    let bulk = (S4 - shear_rate) * trace2;
    (*h)[2u] += shear_rate * (*d)[2u] + bulk;
    (*h)[6u] += shear_rate * (*d)[6u] + bulk;
    (*h)[18u] += shear_rate * (*d)[18u] + bulk;
    (*h)[4u] += shear_rate * (*d)[4u];
    (*h)[10u] += shear_rate * (*d)[10u];
    (*h)[12u] += shear_rate * (*d)[12u];

    // 120 + 102 at s10, 120 - 102 at s23, and likewise for y and z.
    let sum = 0.5 * (odd.s10 + odd.s23);
    let difference = 0.5 * (odd.s10 - odd.s23);
    (*h)[7u] += sum * (*d)[7u] + difference * (*d)[19u];
    (*h)[19u] += sum * (*d)[19u] + difference * (*d)[7u];
    (*h)[5u] += sum * (*d)[5u] + difference * (*d)[21u];
    (*h)[21u] += sum * (*d)[21u] + difference * (*d)[5u];
    (*h)[11u] += sum * (*d)[11u] + difference * (*d)[15u];
    (*h)[15u] += sum * (*d)[15u] + difference * (*d)[11u];
    (*h)[13u] += odd.s26 * (*d)[13u];

    // 220, 202, 022: trace at S16, deviators at S18; 211, 121, 112 at S20.
    let trace4 = ((*d)[8u] + (*d)[20u] + (*d)[24u]) * (1.0 / 3.0);
    let rest = (S16 - S18) * trace4;
    (*h)[8u] += S18 * (*d)[8u] + rest;
    (*h)[20u] += S18 * (*d)[20u] + rest;
    (*h)[24u] += S18 * (*d)[24u] + rest;
    (*h)[14u] += S20 * (*d)[14u];
    (*h)[16u] += S20 * (*d)[16u];
    (*h)[22u] += S20 * (*d)[22u];

    // 122, 212, 221, 222.
    (*h)[25u] += odd.s13 * (*d)[25u];
    (*h)[23u] += odd.s13 * (*d)[23u];
    (*h)[17u] += odd.s13 * (*d)[17u];
    (*h)[26u] += S17 * (*d)[26u];
}
