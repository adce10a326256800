//! Equilibria, shifted: f̃_i^eq = f_i^eq − w_i, and an initial state that includes the viscous stress of its velocity field.

use super::domain::Domain;
use super::lattice::{C, Q, W, c_dot};
use super::rates::{Config, Equilibrium};
use super::wale::gradient;

/// f̃^eq(ρ, u) of the given kind.
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

/// f_i^eq = w_i ρ Π_a [1 + 3 c_a u_a + 9/2 (c_a² − 1/3) u_a²]: the full Hermite series of the lattice.
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

/// f̃_i = f̃_i^eq(ρ, u) + w_i 9/2 (c_ia c_ib − δ_ab/3) Π_ab with Π_ab = −ρ c_s² τ (∂_a u_b + ∂_b u_a)
/// (Latt & Chopard 2006), in every fluid cell; 0 in solids.
pub fn consistent(domain: &Domain, config: &Config, rho: &[f64], u: &[[f64; 3]]) -> Vec<[f64; Q]> {
    (0..domain.cell_count())
        .map(|cell| {
            if domain.solid[cell] {
                return [0.0; Q];
            }
            let mut f = equilibrium(config.equilibrium, rho[cell], u[cell]);
            let g = gradient(domain, u, cell);
            for i in 0..Q {
                f[i] += viscous_part(i, rho[cell], config.tau, &g);
            }
            f
        })
        .collect()
}

fn viscous_part(i: usize, rho: f64, tau: f64, g: &[[f64; 3]; 3]) -> f64 {
    let mut sum = 0.0;
    for a in 0..3 {
        for b in 0..3 {
            let isotropic = if a == b { 1.0 / 3.0 } else { 0.0 };
            let hermite = f64::from(C[i][a] * C[i][b]) - isotropic;
            let stress = -rho / 3.0 * tau * (g[b][a] + g[a][b]);
            sum += hermite * stress;
        }
    }
    4.5 * W[i] * sum
}
