//! Wendland's C2 kernel (Wendland 1995; Dehnen & Aly 2012, table 1).

use std::f64::consts::PI;

/// W(r) = a (1 − r/2h)⁴ (1 + 2r/h) for r < 2h, its integral over space, or over a plane, being one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kernel {
    /// Smoothing length h, m.
    pub smoothing_length: f64,
    /// Its value at r = 0: 21/(16 π h³) in space, 1/m³, and 7/(4 π h²) in a plane, 1/m².
    pub peak: f64,
}

impl Kernel {
    /// That of space with the smoothing length `h` (m).
    pub fn space(h: f64) -> Self {
        Self {
            smoothing_length: h,
            peak: 21.0 / (16.0 * PI * h.powi(3)),
        }
    }

    /// That of a plane with the smoothing length `h` (m).
    pub fn plane(h: f64) -> Self {
        Self {
            smoothing_length: h,
            peak: 7.0 / (4.0 * PI * h * h),
        }
    }

    /// Distance from which on it is 0, m.
    pub fn support(&self) -> f64 {
        2.0 * self.smoothing_length
    }

    /// Its value at the distance `r` (m).
    pub fn at(&self, r: f64) -> f64 {
        let q = r / self.smoothing_length;
        let rest = (1.0 - 0.5 * q).max(0.0);
        self.peak * rest.powi(4) * (1.0 + 2.0 * q)
    }
}
