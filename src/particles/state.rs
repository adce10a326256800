//! What a checkpoint of water has beside its particles.

use super::Works;
use glam::{DMat3, DVec3};

/// What water remembers besides its particles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Longest step that the last one allowed, in the unit of the device.
    pub limit: f32,
    /// Particles that have left.
    pub escaped: u32,
    /// Steps since the start.
    pub steps: u64,
    /// Length of the last exchange, s.
    pub lasted: f64,
    /// Velocity (m/s) and Ḟ (1/s) of each body at its start.
    pub before: Vec<(DVec3, DMat3)>,
    /// What was done to it since the start.
    pub works: Works,
}
