//! Wendland's C2 kernel function (Wendland 1995; Dehnen & Aly 2012, table 1).

use std::f64::consts::PI;

/// W(r) = a (1 − r/2h)⁴ (1 + 2r/h) for r < 2h, normalised to the integral one over space or over a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wendland {
    /// Smoothing length h, m.
    pub smoothing_length: f64,
    /// W(0): 21/(16 π h³) in space, 1/m³, and 7/(4 π h²) in a plane, 1/m².
    pub peak: f64,
}

impl Wendland {
    /// The function of space with the smoothing length `h` (m).
    pub fn space(h: f64) -> Self {
        Self {
            smoothing_length: h,
            peak: 21.0 / (16.0 * PI * h.powi(3)),
        }
    }

    /// The function of a plane with the smoothing length `h` (m).
    pub fn plane(h: f64) -> Self {
        Self {
            smoothing_length: h,
            peak: 7.0 / (4.0 * PI * h * h),
        }
    }

    /// Radius of the support 2h, m.
    pub fn support(&self) -> f64 {
        2.0 * self.smoothing_length
    }

    /// W(r) at the distance `r` (m).
    pub fn at(&self, r: f64) -> f64 {
        let q = r / self.smoothing_length;
        let rest = (1.0 - 0.5 * q).max(0.0);
        self.peak * rest.powi(4) * (1.0 + 2.0 * q)
    }
}
