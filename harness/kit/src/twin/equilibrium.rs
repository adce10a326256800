//! Equilibria, shifted: f̃_i^eq = f_i^eq − w_i.

use super::lattice::{C, Q, W, c_dot};
use super::rates::Equilibrium;

/// f̃^eq(ρ, u) of the kind asked for.
pub fn equilibrium(kind: Equilibrium, rho: f64, u: [f64; 3]) -> [f64; Q] {
    match kind {
        Equilibrium::Order2 => order2(rho, u),
        Equilibrium::Product => product(rho, u),
    }
}

/// f_i^eq = w_i [ρ + 3 c·ρu + ρ (9/2 (c·u)² − 3/2 u²)] (Qian, d'Humières & Lallemand 1992).
pub fn order2(rho: f64, u: [f64; 3]) -> [f64; Q] {
    let u2 = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    std::array::from_fn(|i| {
        let cu = c_dot(i, u);
        W[i] * (rho - 1.0 + rho * (3.0 * cu + 4.5 * cu * cu - 1.5 * u2))
    })
}

/// f_i^eq = w_i ρ Π_a [1 + 3 c_a u_a + 9/2 (c_a² − 1/3) u_a²]: the Hermite series that the lattice can carry in full.
pub fn product(rho: f64, u: [f64; 3]) -> [f64; Q] {
    std::array::from_fn(|i| {
        let factors: f64 = (0..3)
            .map(|a| {
                let c = f64::from(C[i][a]);
                1.0 + 3.0 * c * u[a] + 4.5 * (c * c - 1.0 / 3.0) * u[a] * u[a]
            })
            .product();
        W[i] * (rho * factors - 1.0)
    })
}
