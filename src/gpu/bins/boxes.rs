//! Axis-aligned boxes, sorted into grid levels by size.

use bytemuck::{Pod, Zeroable};

/// Bits of [`DeviceBox::tag`] that hold the number of the item.
pub(crate) const NUMBER_BITS: u32 = 24;

/// Largest number of levels.
pub(crate) const MAX_LEVELS: usize = 203;

/// A box on the device.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct DeviceBox {
    /// Lower corner from the local origin, m.
    pub min: [f32; 3],
    /// Group of the item.
    pub group: u32,
    /// Upper corner from the local origin, m.
    pub max: [f32; 3],
    /// Number of the item in the lower 24 bits, its level in the upper 8.
    pub tag: u32,
}

/// The grid cells of the boxes of one size class.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Level {
    /// Cells per metre, a power of two, so that the multiplication is exact.
    pub scale: f32,
    /// Longest edge of a box of this level, m; at most the edge of a cell.
    pub extent: f32,
}

impl DeviceBox {
    /// Number of the item.
    pub fn number(&self) -> u32 {
        self.tag & ((1 << NUMBER_BITS) - 1)
    }

    /// Level of the box; fine levels come first.
    pub fn level(&self) -> u32 {
        self.tag >> NUMBER_BITS
    }

    /// Whether the two boxes have a point in common. Branch-free, because the result is unpredictable.
    pub fn overlaps(&self, other: &Self) -> bool {
        let along = |a: usize| (self.min[a] <= other.max[a]) & (other.min[a] <= self.max[a]);
        along(0) & along(1) & along(2)
    }
}
