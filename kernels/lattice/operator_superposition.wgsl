// Noble & Torczynski 1998, second form: f_eq(rho, u_s) - f + (1 - 1/tau)(f - f_eq(rho, u)).
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
    let factor = select(1.0 - shear_rate, Real(0.0), interior);
    for (var k = 1u; k < 27u; k++) { // unroll
        (*s)[k] -= factor * (q[k] - (*h)[k]);
    }
    return Real(1.0);
}
