//! A pair of parts that may touch, and its contact while it does.

use crate::rock::{
    contact::{Cache, Seam},
    law::Force,
};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// No contact.
pub(super) const NONE: u32 = u32::MAX;

/// The resolver's limit is a tenth of the smaller distance from centroid to face, of which overlaps are
/// given as shares.
pub(super) const TENTHS: f64 = 10.0;

/// A candidate pair.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Pair {
    /// First and second part, in ascending order.
    pub parts: [u32; 2],
    /// Periods by which the second is moved to be beside the first.
    pub turns: [i32; 3],
    /// What the resolver remembers.
    pub cache: Cache,
    /// Its contact among all contacts, or [`NONE`].
    pub touch: u32,
}

impl Pair {
    pub fn new(parts: [u32; 2], turns: [i32; 3]) -> Self {
        Self {
            parts,
            turns,
            cache: Cache::default(),
            touch: NONE,
        }
    }
}

/// A contact, vectors along the world's axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Touch {
    pub parts: [u32; 2],
    pub blocks: [u32; 2],
    /// Way by which the second is moved to be beside the first, m: that of whole periods.
    pub way: DVec3,
    /// Point of contact, m.
    pub point: DVec3,
    /// Where the force acts, m.
    pub pressure_centre: DVec3,
    /// From the first to the second.
    pub normal: DVec3,
    /// m.
    pub overlap: f64,
    /// That its springs count with, m²; 0 while the pair touches within rounding.
    pub area: f64,
    /// Of the section itself, which strength counts with, m².
    pub section: f64,
    /// m.
    pub width: f64,
    /// Overlap from which the blocks are no longer hard, m.
    pub limit: f64,
    /// On the second block.
    pub force: Force,
    /// Where its faces are bonded.
    pub seam: Seam,
    /// Work done on the springs less that taken by friction, J.
    pub stored: f64,
    /// Rate of work on the springs at the end of the last step, W.
    pub power: f64,
}
