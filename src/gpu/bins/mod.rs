//! Primitives of searches on the device: exclusive scans, and the sorting of boxes into cells.

mod boxes;
mod buffers;
mod cells;
mod scan;

pub use boxes::{DeviceBox, Level};
pub(crate) use boxes::{MAX_LEVELS, NUMBER_BITS};
pub(crate) use buffers::{FEWER_BOXES, at_most};
pub(crate) use cells::buckets;
pub use cells::{Bins, BinsOf};
pub use scan::{Scan, ScanOf};

/// Invocations per workgroup of all kernels of bins, scans and the broadphase.
pub const WORKGROUP: u32 = 64;
