//! Buffers of a search.

use crate::{Error, Result};

/// What to change where a search does not fit.
pub(crate) const FEWER_BOXES: &str =
    "search on the host, in parts of the scene, or on another adapter";

/// Whether the device binds as many bytes at once; `remedy` is what to change if not.
///
/// # Errors
/// [`Error::Limit`] if not.
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
