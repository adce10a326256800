//! What a joint between two faces is like.

use crate::{Error, Result};

/// Stiffness and strength of the joint between two faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// k_n, Pa/m.
    pub normal_stiffness: f64,
    /// k_s, Pa/m.
    pub shear_stiffness: f64,
    /// φ, rad.
    pub friction_angle: f64,
    /// c, Pa.
    pub cohesion: f64,
    /// σ_t, Pa, of the faces that touch at the start, until their bond breaks.
    pub tensile_strength: f64,
    /// ζ, of the critical damping of the two blocks on the contact's springs.
    pub damping: f64,
}

impl Default for Joint {
    /// Dry rock: 1 GPa/m in both directions, 30°, ζ = 0.1.
    fn default() -> Self {
        Self {
            normal_stiffness: 1e9,
            shear_stiffness: 1e9,
            friction_angle: 30f64.to_radians(),
            cohesion: 0.0,
            tensile_strength: 0.0,
            damping: 0.1,
        }
    }
}

impl Joint {
    /// The joint of two materials without a pair of their own: the harmonic mean of
    /// the stiffnesses (springs in series), the weaker of the strengths, the mean of the dampings.
    /// Two faces of one material have that material's joint.
    pub fn between(a: &Self, b: &Self) -> Self {
        let series = |a: f64, b: f64| 2.0 / (1.0 / a + 1.0 / b);
        Self {
            normal_stiffness: series(a.normal_stiffness, b.normal_stiffness),
            shear_stiffness: series(a.shear_stiffness, b.shear_stiffness),
            friction_angle: a.friction_angle.min(b.friction_angle),
            cohesion: a.cohesion.min(b.cohesion),
            tensile_strength: a.tensile_strength.min(b.tensile_strength),
            damping: 0.5 * (a.damping + b.damping),
        }
    }

    /// Whether the numbers can be computed with.
    ///
    /// # Errors
    /// [`Error::Argument`] at `place`, naming the number and its range.
    pub fn check(&self, place: &str) -> Result<()> {
        let refuse = |name: &str, value: f64, range: &str| {
            Err(Error::argument(
                format!("{place}.{name}"),
                format!("{value} must be {range}"),
            ))
        };
        for (name, value) in [
            ("normal_stiffness", self.normal_stiffness),
            ("shear_stiffness", self.shear_stiffness),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return refuse(name, value, "greater than 0 Pa/m");
            }
        }
        for (name, value) in [
            ("cohesion", self.cohesion),
            ("tensile_strength", self.tensile_strength),
        ] {
            if !(value >= 0.0 && value.is_finite()) {
                return refuse(name, value, "0 Pa or more");
            }
        }
        if !(0.0..std::f64::consts::FRAC_PI_2).contains(&self.friction_angle) {
            return refuse(
                "friction_angle",
                self.friction_angle,
                "at least 0 and less than π/2 rad (90°)",
            );
        }
        if !(0.0..=1.0).contains(&self.damping) {
            return refuse("damping", self.damping, "between 0 and 1");
        }
        Ok(())
    }
}
