//! Integral and local measures of a flow.

use super::domain::Domain;
use super::wale::gradient;

/// Σ ½ ρ u² over the fluid cells.
pub fn kinetic_energy(domain: &Domain, rho: &[f64], u: &[[f64; 3]]) -> f64 {
    fluid_cells(domain)
        .map(|cell| 0.5 * rho[cell] * u[cell].iter().map(|v| v * v).sum::<f64>())
        .sum()
}

/// Σ ½ |ω|² over the fluid cells.
pub fn enstrophy(domain: &Domain, u: &[[f64; 3]]) -> f64 {
    fluid_cells(domain)
        .map(|cell| {
            let omega = vorticity(&gradient(domain, u, cell));
            0.5 * omega.iter().map(|v| v * v).sum::<f64>()
        })
        .sum()
}

/// ω = ∇ × u from g_ij = ∂u_i/∂x_j.
pub fn vorticity(g: &[[f64; 3]; 3]) -> [f64; 3] {
    [g[2][1] - g[1][2], g[0][2] - g[2][0], g[1][0] - g[0][1]]
}

/// Q = ½ (Ω:Ω − S:S) = −½ g_ij g_ji (Hunt, Wray & Moin 1988).
pub fn q_criterion(g: &[[f64; 3]; 3]) -> f64 {
    let mut sum = 0.0;
    for i in 0..3 {
        for j in 0..3 {
            sum += g[i][j] * g[j][i];
        }
    }
    -0.5 * sum
}

fn fluid_cells(domain: &Domain) -> impl Iterator<Item = usize> + '_ {
    (0..domain.cell_count()).filter(|&cell| !domain.solid[cell])
}
