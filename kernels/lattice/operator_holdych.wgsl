// Holdych 2003, PhD thesis, University of Illinois: bounce-back relative to the solid,
// f_opposite - f_eq_opposite(rho, u_s) - f + f_eq(rho, u_s): twice the odd moments of f_eq(u_s) - f, no even ones.
// needs velocity, $equilibrium

// Converts the moments of f_eq(rho, u_s) - f to those of the operator; returns the factor of rho u_s in its momentum.
// In the interior of a block the equilibrium replaces all populations: noise there would be reflected forever.
fn solid_operator(
    shear_rate: Real,
    rho: Real,
    u: Vector,
    h: ptr<function, array<Real, 27>>,
    interior: Mask,
    s: ptr<function, array<Real, 27>>,
) -> Real {
    let odd = select(Real(2.0), Real(1.0), interior);
    let even = select(Real(0.0), Real(1.0), interior);
    for (var k = 1u; k < 27u; k++) { // unroll
        if ((k % 3u + (k / 3u) % 3u + k / 9u) % 2u == 1u) {
            (*s)[k] *= odd;
        } else {
            (*s)[k] *= even;
        }
    }
    return odd;
}
