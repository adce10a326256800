//! Collision of one cell: BGK, or MRT with the source of Guo, Zheng & Shi (2002) applied per moment.

use super::equilibrium::equilibrium;
use super::lattice::{Q, W, c_dot, macroscopic};
use super::moments::{self, MomentBasis};
use super::rates::{Config, OddClass, Operator, moment_rates};

/// f̃ after collision. `force` is the force per cell, `nu_t` the eddy viscosity.
pub fn collide(
    config: &Config,
    f: &[f64; Q],
    force: [f64; 3],
    nu_t: f64,
    odd: OddClass,
) -> [f64; Q] {
    let (rho, u) = macroscopic(f, force);
    let f_eq = equilibrium(config.equilibrium, rho, u);
    let source = guo_source(u, force);
    match config.operator {
        Operator::Bgk => bgk(config.tau_eff(nu_t), f, &f_eq, &source),
        Operator::Suga => {
            let rates = moment_rates(config, nu_t, odd);
            mrt(moments::suga(), &rates, f, &f_eq, &source)
        }
        Operator::Hermite => {
            let rates = moment_rates(config, nu_t, odd);
            mrt(moments::hermite(), &rates, f, &f_eq, &source)
        }
    }
}

/// S_i = w_i [3 (c_i − u)·F + 9 (c_i·u)(c_i·F)] (Guo, Zheng & Shi 2002, eq. 20).
pub fn guo_source(u: [f64; 3], force: [f64; 3]) -> [f64; Q] {
    let uf = u[0] * force[0] + u[1] * force[1] + u[2] * force[2];
    std::array::from_fn(|i| {
        let cf = c_dot(i, force);
        W[i] * (3.0 * (cf - uf) + 9.0 * c_dot(i, u) * cf)
    })
}

/// f* = f + (f^eq − f)/τ + (1 − 1/(2τ)) S.
fn bgk(tau: f64, f: &[f64; Q], f_eq: &[f64; Q], source: &[f64; Q]) -> [f64; Q] {
    std::array::from_fn(|i| f[i] + (f_eq[i] - f[i]) / tau + (1.0 - 0.5 / tau) * source[i])
}

/// f* = f + M⁻¹ [S M (f^eq − f) + (I − S/2) M source] (Suga et al. 2015).
fn mrt(
    basis: &MomentBasis,
    rates: &[f64; Q],
    f: &[f64; Q],
    f_eq: &[f64; Q],
    source: &[f64; Q],
) -> [f64; Q] {
    let to_equilibrium = basis.moments(&std::array::from_fn(|i| f_eq[i] - f[i]));
    let force = basis.moments(source);
    let change = basis.populations(&std::array::from_fn(|k| {
        rates[k] * to_equilibrium[k] + (1.0 - 0.5 * rates[k]) * force[k]
    }));
    std::array::from_fn(|i| f[i] + change[i])
}
