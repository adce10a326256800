//! St. Venant & Kirchhoff: stress linear in the strain E = ½(FᵀF − 1), which rotates with the body, so that a
//! rotation of any size causes no strain. S = λ tr E · 1 + 2μE, the second Piola–Kirchhoff stress.

use crate::{Error, Result, geometry::inner};
use glam::DMat3;

/// Isotropic elasticity of the material of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elastic {
    /// Young's modulus, Pa.
    pub youngs_modulus: f64,
    /// Poisson's ratio, no unit.
    pub poissons_ratio: f64,
}

impl Elastic {
    /// Lamé's λ and μ, Pa.
    pub fn lame(&self) -> [f64; 2] {
        let (e, nu) = (self.youngs_modulus, self.poissons_ratio);
        let mu = 0.5 * e / (1.0 + nu);
        [2.0 * mu * nu / (1.0 - 2.0 * nu), mu]
    }

    /// Stress of a strain, Pa.
    pub fn stress(&self, strain: DMat3) -> DMat3 {
        let [lambda, mu] = self.lame();
        DMat3::IDENTITY * (lambda * trace(strain)) + strain * (2.0 * mu)
    }

    /// Energy of a strain per volume, J/m³.
    pub fn energy(&self, strain: DMat3) -> f64 {
        0.5 * inner(self.stress(strain), strain)
    }

    /// Checks the numbers.
    ///
    /// # Errors
    /// [`Error::Argument`] at `place`, naming the number and its range.
    pub fn check(&self, place: &str) -> Result<()> {
        let refuse =
            |name: &str, message: String| Err(Error::argument(format!("{place}.{name}"), message));
        let (e, nu) = (self.youngs_modulus, self.poissons_ratio);
        if !(e > 0.0 && e.is_finite()) {
            return refuse("youngs_modulus", format!("{e} must be greater than 0 Pa"));
        }
        // Outside these bounds the elastic energy is not positive definite.
        if !(nu > -1.0 && nu < 0.5) {
            let message = format!("{nu} must lie between -1 and 0.5, both excluded");
            return refuse("poissons_ratio", message);
        }
        Ok(())
    }
}

/// Von Mises stress of a symmetric stress, √(3/2 s:s) with s its deviator, Pa.
pub fn von_mises(stress: DMat3) -> f64 {
    let deviator = stress - DMat3::IDENTITY * (trace(stress) / 3.0);
    (1.5 * inner(deviator, deviator)).sqrt()
}

/// tr A.
pub(crate) fn trace(a: DMat3) -> f64 {
    a.x_axis.x + a.y_axis.y + a.z_axis.z
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn a_bar_in_tension_stretches_by_its_modulus_and_thins_by_its_ratio() {
        let rock = Elastic {
            youngs_modulus: 5e10,
            poissons_ratio: 0.25,
        };
        let strain = DMat3::from_diagonal(DVec3::new(1.0, -0.25, -0.25) * 1e-5);
        let stress = rock.stress(strain);
        let expected = DMat3::from_diagonal(DVec3::X * 5e5);
        // Sums of terms of this size cancel to zero.
        assert!(stress.abs_diff_eq(expected, 1e-9), "{stress}");
        assert!((rock.energy(strain) / 2.5 - 1.0).abs() < 1e-12);
        assert!((von_mises(stress) / 5e5 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn pressure_has_no_von_mises_stress_and_shear_has_root_three() {
        assert_eq!(von_mises(DMat3::IDENTITY * -2e6), 0.0);
        let shear = DMat3::from_cols(DVec3::Y, DVec3::X, DVec3::ZERO);
        assert!((von_mises(shear) - 3f64.sqrt()).abs() < 1e-15);
    }
}
