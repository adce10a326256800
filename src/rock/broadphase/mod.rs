//! Which pairs may touch: a list that is complete, sorted and the same from every finder.
//!
//! Finders take boxes as they are given: whoever wants a list to live for several steps grows its
//! boxes by a skin first, and asks again once something has moved half of it.

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
        // Without branches, which nobody could predict.
        let along = |a: usize| (self.min[a] <= other.max[a]) & (other.min[a] <= self.max[a]);
        along(0) & along(1) & along(2)
    }

    /// Whether the two may touch: their boxes do, and they are of different groups.
    pub fn pairs_with(&self, other: &Self) -> bool {
        (self.group != other.group) & self.overlaps(other)
    }
}

/// Finds the pairs of items of different groups whose boxes overlap.
pub trait Broadphase {
    /// The pairs (i, j), i < j, sorted, each once. Two finders give the same list, bit for bit.
    ///
    /// # Errors
    /// If a device fails, or an item is not finite.
    fn pairs(&mut self, aabbs: &[Aabb]) -> impl Future<Output = Result<Vec<[u32; 2]>>>;
}

/// Most storage buffers in a kernel of [`DeviceBroadphase`].
pub const MAX_STORAGE_BUFFERS: u32 = 6;
