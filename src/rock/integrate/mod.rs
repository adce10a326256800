//! Time integration of rigid and affine bodies under given forces.
//!
//! Velocity Verlet with mass damping (Gardner & Sitar 2018, eq. 1): m(ẍ + αẋ) = F + mg.
//!
//! The update v⁺ = [v(1 − αΔt/2) + aΔt]/(1 + αΔt/2) is split into two kicks, between which the position drifts with
//! v½. The velocity at a whole step is the mean of the half-step velocities, so that the work is exact. The same scheme
//! advances momentum with force, angular momentum with torque, and the deformation rate. With steps of different
//! lengths it is the central difference of Mikola & Sitar 2014, eqs. 5–6.
//!
//! Free rotation uses a symmetric splitting about the principal axes (Dullweber, Leimkuhler & McLachlan
//! 1997; McLachlan 1993): the kinetic energy is Σ L_i²/2I_i, and under each term alone the body rotates
//! about that axis at the constant rate L_i/I_i. The angular momentum in the world's axes is conserved
//! for any step; the energy stays bounded.

mod affine;

pub(crate) use crate::geometry::axial;
pub use affine::{Affine, PointConstraints, Wrench, polar};

use glam::{DMat3, DQuat, DVec3};
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

/// Rotation of a body after `dt` (s) of free rotation with the angular momentum `momentum` (kg m²/s,
/// world). `body`: its principal moments (kg m²) and axes.
pub fn turn(body: &Principal, rotation: DQuat, momentum: DVec3, dt: f64) -> DQuat {
    let mut frame = rotation * body.axes;
    let mut inner = frame.conjugate() * momentum;
    for (axis, share) in [(0, 0.5), (1, 0.5), (2, 1.0), (1, 0.5), (0, 0.5)] {
        let angle = share * dt * inner[axis] / body.moments[axis];
        let mut along = DVec3::ZERO;
        along[axis] = 1.0;
        let step = DQuat::from_axis_angle(along, angle);
        frame *= step;
        inner = step.conjugate() * inner;
    }
    (frame * body.axes.conjugate()).normalize()
}

/// Spin (rad/s, world) of a body with the angular momentum `momentum` (kg m²/s, world).
pub fn spin(body: &Principal, rotation: DQuat, momentum: DVec3) -> DVec3 {
    let frame = rotation * body.axes;
    frame * ((frame.conjugate() * momentum) / body.moments)
}

/// Principal moments and axes of a body, computed once per shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Principal {
    /// Moments about the three axes, in the unit of the tensor.
    pub moments: DVec3,
    /// Rotation from the principal frame to the body's.
    pub axes: DQuat,
}

impl Principal {
    /// Moments and axes of a symmetric tensor, by Jacobi rotations. A diagonal tensor keeps its axes exactly.
    pub fn of(tensor: DMat3) -> Self {
        let mut d = tensor;
        let mut axes = DMat3::IDENTITY;
        // Cyclic Jacobi converges quadratically: six sweeps reach the last bit for any tensor.
        for _ in 0..12 {
            for (p, q) in [(0, 1), (0, 2), (1, 2)] {
                let off = 0.5 * (d.col(p)[q] + d.col(q)[p]);
                // Off-diagonals at rounding level are skipped.
                if off.abs() <= 1e-15 * (d.col(p)[p].abs() + d.col(q)[q].abs()) {
                    continue;
                }
                let theta = 0.5 * (d.col(q)[q] - d.col(p)[p]) / off;
                let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
                let c = 1.0 / t.hypot(1.0);
                let mut turn = DMat3::IDENTITY;
                turn.col_mut(p)[p] = c;
                turn.col_mut(q)[q] = c;
                turn.col_mut(q)[p] = t * c;
                turn.col_mut(p)[q] = -t * c;
                d = turn.transpose() * d * turn;
                axes *= turn;
            }
        }
        Self {
            moments: DVec3::new(d.x_axis.x, d.y_axis.y, d.z_axis.z),
            axes: DQuat::from_mat3(&axes).normalize(),
        }
    }

    /// A body with this tensor that turns only about the unit vector `axis`, or not at all. The moments about other axes are so large
    /// that no torque matters.
    pub fn held(tensor: DMat3, axis: Option<DVec3>) -> Self {
        const HELD: f64 = 1e12;
        let held = HELD * (tensor.x_axis.x + tensor.y_axis.y + tensor.z_axis.z);
        let axis_and_moment = axis.map(|axis| (axis, axis.dot(tensor * axis)));
        let (axis, moment) = axis_and_moment.unwrap_or((DVec3::X, held));
        Self {
            moments: DVec3::new(moment, held, held),
            axes: DQuat::from_rotation_arc(DVec3::X, axis),
        }
    }

    /// The same axes with `factor` times the moments.
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            moments: self.moments * factor,
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_tensor_gets_its_moments_back() {
        let moments = DVec3::new(1.0, 2.0, 3.0);
        let turn = DMat3::from_quat(DQuat::from_xyzw(0.3, -0.5, 0.2, 0.8).normalize());
        let tensor = turn * DMat3::from_diagonal(moments) * turn.transpose();
        let found = Principal::of(tensor);
        let axes = DMat3::from_quat(found.axes);
        let back = axes * DMat3::from_diagonal(found.moments) * axes.transpose();
        assert!((back - tensor).abs_diff_eq(DMat3::ZERO, 1e-14), "{back}");
        let mut sorted = found.moments.to_array();
        sorted.sort_by(f64::total_cmp);
        assert!(DVec3::from(sorted).abs_diff_eq(moments, 1e-14));
    }

    #[test]
    fn a_diagonal_tensor_keeps_its_axes() {
        let found = Principal::of(DMat3::from_diagonal(DVec3::new(3.0, 1.0, 2.0)));
        assert_eq!(found.axes, DQuat::IDENTITY);
        assert_eq!(found.moments, DVec3::new(3.0, 1.0, 2.0));
    }
}
