//! Velocity Verlet with mass damping (Gardner & Sitar 2018, eq. 1): m(ẍ + αẋ) = F + mg.
//!
//! The two halves of v⁺ = [v(1 − αΔt/2) + aΔt]/(1 + αΔt/2), between which the position moves with v½.
//! They meet in the mean of the half-step velocities, so that their work is exact: the same for momentum
//! with force as for angular momentum with torque.

use glam::DVec3;

/// v½ from v: the first half of a step of `dt` (s) with the rate `a` and the damping `alpha` (1/s).
pub fn first_kick(v: DVec3, a: DVec3, alpha: f64, dt: f64) -> DVec3 {
    v * (1.0 - 0.5 * alpha * dt) + a * (0.5 * dt)
}

/// v from v½: the second half of a step, with the rate at its end.
pub fn second_kick(half: DVec3, a: DVec3, alpha: f64, dt: f64) -> DVec3 {
    (half + a * (0.5 * dt)) / (1.0 + 0.5 * alpha * dt)
}
