//! A start that already carries the viscous stress of its velocity field.

use super::domain::Domain;
use super::equilibrium::equilibrium;
use super::lattice::{C, Q, W};
use super::rates::Config;
use super::wale::gradient;

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
