// Cole 1948, Underwater Explosions, after Tait: p = ((rho/rho_0)^7 - 1)/7, in units of rho_0 c^2.

// Expanded in the excess: the difference of numbers near 1 would lose the digits of a small excess.
fn pressure_of(excess: f32) -> f32 {
    let e = excess;
    return e * (1.0 + e * (3.0 + e * (5.0 + e * (5.0 + e * (3.0 + e * (1.0 + e / 7.0))))));
}

// Newton's method from a first guess; the pressures are a few percent at most.
fn excess_of(pressure: f32) -> f32 {
    var e = pressure / (1.0 + 3.0 * pressure);
    for (var k = 0; k < 3; k++) {
        let rho = 1.0 + e;
        let cube = rho * rho * rho;
        e -= (pressure_of(e) - pressure) / (cube * cube);
    }
    return e;
}
