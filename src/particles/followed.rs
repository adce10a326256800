//! How walls and blocks have moved from one exchange to the next.

use super::Body;
use crate::bodies::Pose;
use glam::{DMat3, DVec3};

/// The bodies as they were at the start of the last exchange.
#[derive(Clone, Debug, Default)]
pub(super) struct Followed {
    /// How far each shell reaches from the centroid of its body, m.
    reaches: Vec<f64>,
    /// Where they were; empty if that is not known.
    poses: Vec<Pose>,
    /// Velocity (m/s) and Ḟ (1/s) of each.
    pub before: Vec<(DVec3, DMat3)>,
    /// How long the exchange took, s.
    pub lasted: f64,
}

impl Followed {
    /// Of bodies that have not moved yet.
    pub fn new(bodies: &[Body]) -> Self {
        let reach = |body: &Body| body.shell.iter().map(|x| x.length()).fold(0.0, f64::max);
        Self {
            reaches: bodies.iter().map(reach).collect(),
            ..Self::default()
        }
    }

    /// The same with other velocities before, its places unknown.
    pub fn restored(&self, before: &[(DVec3, DMat3)], lasted: f64) -> Self {
        Self {
            reaches: self.reaches.clone(),
            poses: Vec::new(),
            before: before.to_vec(),
            lasted,
        }
    }

    /// Accelerations of a body, m/s² and 1/s², since then; none before the second exchange.
    pub fn acceleration(&self, body: usize, pose: &Pose) -> Option<(DVec3, DMat3)> {
        let (velocity, turning) = self.before.get(body)?;
        let rate = (pose.velocity - *velocity) / self.lasted;
        let change = (pose.deformation_rate - *turning) * (1.0 / self.lasted);
        (self.lasted > 0.0).then_some((rate, change))
    }

    /// The fastest that any particle of a shell moves, m/s, or somewhat more.
    pub fn fastest(&self, poses: &[Pose]) -> f64 {
        let speed = |(pose, reach): (&Pose, &f64)| {
            pose.velocity.length() + size(pose.deformation_rate) * reach
        };
        poses
            .iter()
            .zip(&self.reaches)
            .map(speed)
            .fold(0.0, f64::max)
    }

    /// How far the bodies are from where the last exchange would have had them, m, or somewhat more.
    pub fn jump(&self, poses: &[Pose]) -> f64 {
        let jump = |((new, old), reach): ((&Pose, &Pose), &f64)| {
            let centre = old.centre + self.lasted * old.velocity;
            let shape = old.deformation + old.deformation_rate * self.lasted;
            (new.centre - centre).length() + size(new.deformation - shape) * reach
        };
        let jumps = poses.iter().zip(&self.poses).zip(&self.reaches).map(jump);
        jumps.fold(0.0, f64::max)
    }

    /// An exchange of `time` (s) has begun with these.
    pub fn follow(&mut self, poses: &[Pose], time: f64) {
        self.poses.clear();
        self.poses.extend_from_slice(poses);
        let rates = poses
            .iter()
            .map(|pose| (pose.velocity, pose.deformation_rate));
        self.before = rates.collect();
        self.lasted = time;
    }
}

/// Root of the sum of the squares of a matrix, by which it lengthens no vector more.
fn size(m: DMat3) -> f64 {
    m.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt()
}
