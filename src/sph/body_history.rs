//! Motion of walls and blocks from one exchange to the next.

use super::Body;
use crate::geometry::Pose;
use glam::{DMat3, DVec3};

/// The bodies at the start of the last exchange.
#[derive(Clone, Debug, Default)]
pub(super) struct BodyHistory {
    /// Largest distance of a boundary particle from the centroid of its body, m.
    radii: Vec<f64>,
    /// Poses at the start of the last exchange; empty after a restart.
    poses: Vec<Pose>,
    /// Velocity (m/s) and Ḟ (1/s) of each body at the start of the last exchange.
    pub previous_rates: Vec<(DVec3, DMat3)>,
    /// Length of the last exchange, s.
    pub last_duration: f64,
}

impl BodyHistory {
    /// The history before the first exchange.
    pub fn new(bodies: &[Body]) -> Self {
        let radius = |body: &Body| {
            let distances = body.boundary.iter().map(|x| x.length());
            distances.fold(0.0, f64::max)
        };
        Self {
            radii: bodies.iter().map(radius).collect(),
            ..Self::default()
        }
    }

    /// The history after a restart with these rates; the previous poses are unknown.
    pub fn restored(&self, previous_rates: &[(DVec3, DMat3)], last_duration: f64) -> Self {
        Self {
            radii: self.radii.clone(),
            poses: Vec::new(),
            previous_rates: previous_rates.to_vec(),
            last_duration,
        }
    }

    /// Acceleration (m/s²) and F̈ (1/s²) of a body over the last exchange; `None` before the second exchange.
    pub fn acceleration(&self, body: usize, pose: &Pose) -> Option<(DVec3, DMat3)> {
        let (velocity, deformation_rate) = self.previous_rates.get(body)?;
        let acceleration = (pose.velocity - *velocity) / self.last_duration;
        let change = (pose.deformation_rate - *deformation_rate) * (1.0 / self.last_duration);
        (self.last_duration > 0.0).then_some((acceleration, change))
    }

    /// Upper bound on the speed of any boundary particle, m/s.
    pub fn max_speed(&self, poses: &[Pose]) -> f64 {
        let speed = |(pose, radius): (&Pose, &f64)| {
            pose.velocity.length() + frobenius_norm(pose.deformation_rate) * radius
        };
        poses.iter().zip(&self.radii).map(speed).fold(0.0, f64::max)
    }

    /// Upper bound on the distance of any boundary particle from its position extrapolated over the last exchange, m.
    pub fn jump(&self, poses: &[Pose]) -> f64 {
        let jump = |((new, old), radius): ((&Pose, &Pose), &f64)| {
            let centre = old.centre + self.last_duration * old.velocity;
            let shape = old.deformation + old.deformation_rate * self.last_duration;
            (new.centre - centre).length() + frobenius_norm(new.deformation - shape) * radius
        };
        let jumps = poses.iter().zip(&self.poses).zip(&self.radii).map(jump);
        jumps.fold(0.0, f64::max)
    }

    /// Records the poses at the start of an exchange of `duration` (s).
    pub fn record(&mut self, poses: &[Pose], duration: f64) {
        self.poses.clear();
        self.poses.extend_from_slice(poses);
        let rates = poses
            .iter()
            .map(|pose| (pose.velocity, pose.deformation_rate));
        self.previous_rates = rates.collect();
        self.last_duration = duration;
    }
}

/// Frobenius norm, an upper bound on the spectral norm.
fn frobenius_norm(m: DMat3) -> f64 {
    m.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt()
}
