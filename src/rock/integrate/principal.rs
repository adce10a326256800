//! The frame in which an inertia tensor is diagonal.

use glam::{DMat3, DQuat, DVec3};

/// Principal moments and axes of a body, found once for each shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Principal {
    /// Moments about the three axes, in the unit of the tensor.
    pub moments: DVec3,
    /// Turns vectors of the principal frame into the body's.
    pub axes: DQuat,
}

impl Principal {
    /// Of a symmetric tensor, by Jacobi rotations; a diagonal one keeps its axes exactly.
    pub fn of(tensor: DMat3) -> Self {
        let mut d = tensor;
        let mut axes = DMat3::IDENTITY;
        // Cyclic Jacobi converges quadratically: six sweeps reach the last bit from anywhere.
        for _ in 0..12 {
            for (p, q) in [(0, 1), (0, 2), (1, 2)] {
                let off = 0.5 * (d.col(p)[q] + d.col(q)[p]);
                // Of what rounding leaves of a zero no rotation is made.
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
