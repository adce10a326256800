//! Buffers of a search.

use crate::{Error, Result};

/// Remedy for a search that exceeds the limits of the device.
pub(crate) const FEWER_BOXES: &str =
    "search on the host, in parts of the scene, or on another adapter";

/// Checks that `bytes` fit into one storage binding of the device.
///
/// # Errors
/// [`Error::Limit`] with `remedy` if they do not.
pub(crate) fn at_most(device: &wgpu::Device, what: &str, bytes: u64, remedy: &str) -> Result<()> {
    let limits = device.limits();
    let has = limits
        .max_storage_buffer_binding_size
        .min(limits.max_buffer_size);
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
