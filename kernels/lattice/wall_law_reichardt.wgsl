// Reichardt 1951, Z. angew. Math. Mech. 31:208: u+ = ln(1 + k y+)/k + c (1 - exp(-y+/11) - y+/11 exp(-y+/3)) at any distance,
// with k = 0.384 and c = B - ln(k)/k of the log law with B = 4.27. The wall stress of a smooth wall from the speed u at the
// distance y, by Newton's method from the power law of Werner & Wengle 1991.

// Kinematic viscosity of the fluid, lattice units.
override VISCOSITY: f32;

const KARMAN_SMOOTH = 0.384;
const BUFFER = 6.762481;

// Stress over density.
fn smooth_wall_stress(u: f32, y: f32) -> f32 {
    let re = u * y / VISCOSITY;
    if (!(re > 1e-3)) {
        return VISCOSITY * u / y;
    }
    // y+ of the linear law, or of the power law beyond it.
    var at = max(sqrt(re), 1e-3);
    if (re > 140.0) {
        at = exp(0.875 * log(re / 8.3));
    }
    for (var k = 0; k < 5; k++) {
        let far = exp(-at / 11.0);
        let near = exp(-at / 3.0);
        let speed = log(1.0 + KARMAN_SMOOTH * at) / KARMAN_SMOOTH + BUFFER * (1.0 - far - at / 11.0 * near);
        let slope = 1.0 / (1.0 + KARMAN_SMOOTH * at) + BUFFER * (far / 11.0 - near / 11.0 + at / 33.0 * near);
        // at speed(at) = re
        at = max(at - (at * speed - re) / (speed + at * slope), 1e-3);
    }
    let friction = VISCOSITY * at / y;
    return friction * friction;
}
