//! The two moment bases of the MRT operators.

use std::sync::OnceLock;

use super::lattice::{Q, W};

/// 27 polynomials on the lattice, orthogonal under `weight`.
pub struct MomentBasis {
    /// Value of polynomial k in direction i.
    pub rows: [[f64; Q]; Q],
    /// Weight of direction i in the scalar product.
    pub weight: [f64; Q],
    /// Σ_i weight_i rows_ki².
    pub norm: [f64; Q],
}

impl MomentBasis {
    /// m_k = Σ_i rows_ki f_i.
    pub fn moments(&self, f: &[f64; Q]) -> [f64; Q] {
        std::array::from_fn(|k| dot(&self.rows[k], f))
    }

    /// f_i = weight_i Σ_k rows_ki m_k / norm_k, the inverse of [`Self::moments`];
    /// the moments are taken with unit weight, so weight_i belongs to the inverse.
    pub fn populations(&self, m: &[f64; Q]) -> [f64; Q] {
        let mut f = [0.0; Q];
        for k in 0..Q {
            let amplitude = m[k] / self.norm[k];
            for i in 0..Q {
                f[i] += self.weight[i] * self.rows[k][i] * amplitude;
            }
        }
        f
    }
}

/// Suga et al. (2015): orthogonal with unit weight, as printed.
pub fn suga() -> &'static MomentBasis {
    static BASIS: OnceLock<MomentBasis> = OnceLock::new();
    BASIS.get_or_init(|| {
        let weight = [1.0; Q];
        let rows = exact_matrix();
        MomentBasis {
            norm: std::array::from_fn(|k| scalar_product(&weight, &rows[k], &rows[k])),
            rows,
            weight,
        }
    })
}

/// Suga's polynomials orthogonalised under w_i by Gram–Schmidt in their own order.
pub fn hermite() -> &'static MomentBasis {
    static BASIS: OnceLock<MomentBasis> = OnceLock::new();
    BASIS.get_or_init(|| {
        let mut rows = exact_matrix();
        let mut norm = [0.0; Q];
        for k in 0..Q {
            for earlier in 0..k {
                let part = scalar_product(&W, &rows[k], &rows[earlier]) / norm[earlier];
                for i in 0..Q {
                    rows[k][i] -= part * rows[earlier][i];
                }
            }
            norm[k] = scalar_product(&W, &rows[k], &rows[k]);
        }
        MomentBasis {
            rows,
            weight: W,
            norm,
        }
    })
}

/// Σ_i weight_i a_i b_i.
pub fn scalar_product(weight: &[f64; Q], a: &[f64; Q], b: &[f64; Q]) -> f64 {
    (0..Q).map(|i| weight[i] * a[i] * b[i]).sum()
}

/// The data file shared by the twin and its tests.
pub fn exact_data() -> &'static serde_json::Value {
    static DATA: OnceLock<serde_json::Value> = OnceLock::new();
    DATA.get_or_init(|| {
        serde_json::from_str(include_str!("../../data/suga_mrt_exact.json"))
            .expect("the data file is JSON")
    })
}

/// A rational number such as `-1` or `8/27`.
pub fn rational(text: &str) -> f64 {
    let number = |part: &str| part.parse::<f64>().expect("a rational number");
    match text.split_once('/') {
        Some((numerator, denominator)) => number(numerator) / number(denominator),
        None => number(text),
    }
}

fn exact_matrix() -> [[f64; Q]; Q] {
    let rows = &exact_data()["M"];
    std::array::from_fn(|k| {
        std::array::from_fn(|i| rational(rows[k][i].as_str().expect("M holds strings")))
    })
}

fn dot(a: &[f64; Q], b: &[f64; Q]) -> f64 {
    (0..Q).map(|i| a[i] * b[i]).sum()
}
