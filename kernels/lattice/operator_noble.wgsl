// Noble & Torczynski 1998, Int. J. Mod. Phys. C 9:1189: f_opposite - f_eq_opposite(rho, u) - f + f_eq(rho, u_s):
// (f_eq(u_s) - f) + (f_eq(u) - f) for odd moments, the difference of the two for even moments.
// needs velocity, $equilibrium

// Converts the moments of f_eq(rho, u_s) - f to those of the operator; returns the factor of rho u_s in its momentum.
// f_eq(rho, u_s) - f replaces all of it in the interior of a block.
fn solid_operator(
    shear_rate: Real,
    rho: Real,
    u: Vector,
    h: ptr<function, array<Real, 27>>,
    interior: Mask,
    damping: Real,
    s: ptr<function, array<Real, 27>>,
) -> Real {
    let q = equilibrium(rho, u);
    let factor = select(Real(1.0), Real(0.0), interior);
    for (var k = 1u; k < 27u; k++) { // unroll
        if ((k % 3u + (k / 3u) % 3u + k / 9u) % 2u == 1u) {
            (*s)[k] += factor * (q[k] - (*h)[k]);
        } else {
            (*s)[k] -= factor * (q[k] - (*h)[k]);
        }
    }
    return Real(1.0);
}
