//! Which pairs may touch: a list that is complete, sorted and the same from every implementation.
//!
//! Broadphases take boxes as they are given: to keep a list for several steps, grow the
//! boxes by a skin first, and search again once something has moved half of it.

use crate::Result;

mod auto;
mod boxes;
mod comparison;
mod device;
mod host;
mod sorted_pairs;

pub use auto::AutoBroadphase;
pub use boxes::{Boxes, FARTHEST};
pub use comparison::{Header, Search};
pub use device::DeviceBroadphase;
pub use host::HostBroadphase;

/// A box along the axes around something that may touch others, already grown by the skin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Lower corner, m.
    pub min: [f64; 3],
    /// Upper corner, m.
    pub max: [f64; 3],
    /// Items of one group never pair: the parts of a compound, everything that is fixed.
    pub group: u32,
}

impl Aabb {
    /// Whether the two boxes have a point in common.
    pub fn overlaps(&self, other: &Self) -> bool {
        // Without branches, which would be mispredicted.
        let along = |a: usize| (self.min[a] <= other.max[a]) & (other.min[a] <= self.max[a]);
        along(0) & along(1) & along(2)
    }

    /// Whether the two may touch: their boxes do, and they are of different groups.
    pub fn pairs_with(&self, other: &Self) -> bool {
        (self.group != other.group) & self.overlaps(other)
    }
}

/// Finds the pairs of boxes of different groups that overlap.
pub trait Broadphase {
    /// The pairs (i, j), i < j, sorted, each once. Two broadphases give the same list, bit for bit.
    ///
    /// # Errors
    /// If a device fails, or a box is not finite.
    fn pairs(&mut self, aabbs: &[Aabb]) -> impl Future<Output = Result<Vec<[u32; 2]>>>;
}

/// Most storage buffers in a kernel of [`DeviceBroadphase`].
pub const MAX_STORAGE_BUFFERS: u32 = 6;
