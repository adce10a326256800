//! Hart, Cundall & Lemos 1988: the longest stable step, from an upper bound of the highest frequency.
//!
//! ω² = max over the blocks of 2·max(Σ(k_n + k_s) A/m, Σ(k_n + k_s) A (|r|² + w²/4)/I_min), r from the
//! block's centroid to the contact, w the width of its section; Δt ≤ share · 2/ω.

use super::Joint;
use glam::DVec3;

/// Share of 2/ω that a step takes by default.
pub const USUAL_SHARE: f64 = 0.1;
/// Largest share of 2/ω that a step may take.
pub const LARGEST_SHARE: f64 = 0.2;

/// The springs that hold one block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stiffness {
    /// Σ(k_n + k_s) A, N/m.
    pub translation: f64,
    /// Σ(k_n + k_s) A (|r|² + w²/4), N m.
    pub rotation: f64,
}

impl Stiffness {
    /// Adds a contact of `area` (m²) and `width` (m) at `arm` (m) from the centroid.
    pub fn add(&mut self, joint: &Joint, area: f64, arm: DVec3, width: f64) {
        let k = (joint.normal_stiffness + joint.shear_stiffness) * area;
        self.translation += k;
        self.rotation += k * (arm.length_squared() + 0.25 * width * width);
    }

    /// ω² of a block of `mass` (kg) and least moment of inertia `moment` (kg m²), rad²/s².
    pub fn frequency_squared(&self, mass: f64, moment: f64) -> f64 {
        2.0 * (self.translation / mass).max(self.rotation / moment)
    }
}

/// `share` of 2/ω, s; infinite without springs.
pub fn longest_step(share: f64, frequency_squared: f64) -> f64 {
    share * 2.0 / frequency_squared.sqrt()
}
