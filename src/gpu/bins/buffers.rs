//! Buffers of a search.

use crate::{Error, Result, gpu::kernel::largest_binding};

/// Remedy for a search that exceeds the limits of the device.
pub(crate) const FEWER_BOXES: &str =
    "search on the host, in parts of the scene, or on another adapter";

/// Checks that `bytes` fit into one storage binding of the device.
///
/// # Errors
/// [`Error::Limit`] with `remedy` if they do not.
pub(crate) fn at_most(device: &wgpu::Device, what: &str, bytes: u64, remedy: &str) -> Result<()> {
    let has = largest_binding(&device.limits());
    if bytes <= has {
        return Ok(());
    }
    Err(Error::Limit {
        name: format!("bytes of one storage binding ({what})"),
        wants: bytes,
        has,
        remedy: remedy.into(),
    })
}
