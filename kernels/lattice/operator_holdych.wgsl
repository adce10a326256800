// Holdych 2003, PhD thesis, University of Illinois: the solid bounces back what moves against it,
// f_opposite - f_eq_opposite(rho, u_s) - f + f_eq(rho, u_s): twice the odd moments of f_eq(u_s) - f, no even ones.
// needs velocity, $equilibrium

// Makes the moments of the operator of those of f_eq(rho, u_s) - f; returns how often rho u_s is in its momentum.
// In the interior of a block the equilibrium replaces all: noise there would be reflected for ever.
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
