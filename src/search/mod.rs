//! Building blocks of searches on the device: sums of all before, and cells with what lies in them.

mod bins;
mod boxes;
mod buffers;
mod scan;

pub(crate) use bins::buckets;
pub use bins::{Bins, BinsOf};
pub use boxes::{DeviceBox, Level};
pub(crate) use boxes::{MAX_LEVELS, NUMBER_BITS};
pub(crate) use buffers::{FEWER_BOXES, at_most, storage, uniform};
pub use scan::{Scan, ScanOf};

/// Invocations of a workgroup of every kernel in `kernels/search/`.
pub const WORKGROUP: u32 = 64;
