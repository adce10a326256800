// Holdych 2003, PhD thesis, University of Illinois: bounce-back relative to the solid,
// f_opposite - f_eq_opposite(rho, u_s) - f + f_eq(rho, u_s): twice the odd moments of f_eq(u_s) - f, no even ones.
// needs velocity, $equilibrium

// Converts the moments of f_eq(rho, u_s) - f to those of the operator; returns the factor of rho u_s in its momentum.
// f_eq(rho, u_s) - f replaces all of it in the interior of a block, and the part `damping` elsewhere.
fn solid_operator(
    shear_rate: Real,
    rho: Real,
    u: Vector,
    h: ptr<function, array<Real, 27>>,
    interior: Mask,
    damping: Real,
    s: ptr<function, array<Real, 27>>,
) -> Real {
    let even = select(damping, Real(1.0), interior);
    let odd = 2.0 - even;
    for (var k = 1u; k < 27u; k++) { // unroll
        if ((k % 3u + (k / 3u) % 3u + k / 9u) % 2u == 1u) {
            (*s)[k] *= odd;
        } else {
            (*s)[k] *= even;
        }
    }
    return odd;
}
