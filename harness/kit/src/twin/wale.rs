//! WALE eddy viscosity (Nicoud & Ducros 1999, eq. 13) and its velocity gradient.

use super::domain::Domain;

/// ν_t = (C_w Δ)² (S^d:S^d)^{3/2} / [(S:S)^{5/2} + (S^d:S^d)^{5/4}] with Δ = 1, g_ij = ∂u_i/∂x_j,
/// S = ½(g + gᵀ), S^d = ½(g² + g²ᵀ) − ⅓ tr(g²) I; 0 where the denominator underflows.
pub fn nu_t(g: &[[f64; 3]; 3], c_w: f64) -> f64 {
    let square: [[f64; 3]; 3] =
        std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| g[i][k] * g[k][j]).sum()));
    let third_of_trace = (square[0][0] + square[1][1] + square[2][2]) / 3.0;
    let mut s2 = 0.0;
    let mut sd2 = 0.0;
    for i in 0..3 {
        for j in 0..3 {
            let s = 0.5 * (g[i][j] + g[j][i]);
            let isotropic = if i == j { third_of_trace } else { 0.0 };
            let sd = 0.5 * (square[i][j] + square[j][i]) - isotropic;
            s2 += s * s;
            sd2 += sd * sd;
        }
    }
    let denominator = s2.powf(2.5) + sd2.powf(1.25);
    if denominator < f64::MIN_POSITIVE {
        return 0.0;
    }
    c_w * c_w * sd2.powf(1.5) / denominator
}

/// g_ij = ∂u_i/∂x_j at a fluid cell: central, one-sided next to a solid or a face that is not periodic,
/// 0 along an axis without fluid neighbours.
pub fn gradient(domain: &Domain, u: &[[f64; 3]], cell: usize) -> [[f64; 3]; 3] {
    let mut g = [[0.0; 3]; 3];
    for axis in 0..3 {
        let below = domain.fluid_neighbour(cell, axis, -1);
        let above = domain.fluid_neighbour(cell, axis, 1);
        let (low, high, distance) = match (below, above) {
            (Some(low), Some(high)) => (low, high, 2.0),
            (Some(low), None) => (low, cell, 1.0),
            (None, Some(high)) => (cell, high, 1.0),
            (None, None) => continue,
        };
        for component in 0..3 {
            g[component][axis] = (u[high][component] - u[low][component]) / distance;
        }
    }
    g
}
