//! Velocity Verlet with mass damping (Gardner & Sitar 2018, eq. 1): m(ẍ + αẋ) = F + mg.
//!
//! The two halves of v⁺ = [v(1 − αΔt/2) + aΔt]/(1 + αΔt/2), between which the position moves with v½.
//! They meet in the mean of the half-step velocities, so that their work is exact: the same for momentum
//! with force as for angular momentum with torque, and for the rate of a deformation. With steps of different
//! lengths these are the central differences of Mikola & Sitar 2014, eqs. 5–6.

use std::ops::{Add, Div, Mul};

/// v½ from v: the first half of a step of `dt` (s) with the rate `a` and the damping `alpha` (1/s).
pub fn first_kick<V>(v: V, a: V, alpha: f64, dt: f64) -> V
where
    V: Add<Output = V> + Mul<f64, Output = V>,
{
    v * (1.0 - 0.5 * alpha * dt) + a * (0.5 * dt)
}

/// v from v½: the second half of a step, with the rate at its end.
pub fn second_kick<V>(half: V, a: V, alpha: f64, dt: f64) -> V
where
    V: Add<Output = V> + Mul<f64, Output = V> + Div<f64, Output = V>,
{
    (half + a * (0.5 * dt)) / (1.0 + 0.5 * alpha * dt)
}
