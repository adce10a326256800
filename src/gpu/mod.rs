//! Device side of every kernel: linking of WGSL files, pipelines, buffers, readback, timing, and the sorting primitives that
//! SPH and the broadphase share.

pub mod bins;
pub(crate) mod filled;
pub mod kernel;
pub mod layout;
pub mod link;
#[cfg(feature = "checkpoint")]
pub(crate) mod plain_bytes;
pub mod readback;
pub mod timer;
