//! Asynchronous readback of buffers through a reusable staging buffer.

use crate::{Error, Result};
use std::{
    future::poll_fn,
    sync::{Arc, Mutex},
    task::{Poll, Waker},
};

/// Copies device buffers to the host. On native systems, the caller must poll the device (`device.poll`) while a read is
/// pending; browsers poll by themselves.
#[derive(Debug, Default)]
pub struct Readback {
    staging: Option<wgpu::Buffer>,
}

#[derive(Default)]
struct Mapped {
    result: Option<std::result::Result<(), wgpu::BufferAsyncError>>,
    waker: Option<Waker>,
}

impl Readback {
    /// Reads the first `count` values of `buffer` after all work submitted before.
    ///
    /// # Errors
    /// [`Error::Device`] if the buffer has fewer values or lacks `COPY_SRC`, or if the values are not a whole number of 4-byte
    /// words; [`Error::DeviceLost`] if the copy cannot be mapped.
    pub async fn read<T: bytemuck::Pod>(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        buffer: &wgpu::Buffer,
        count: usize,
    ) -> Result<Vec<T>> {
        let bytes = (count as u64).saturating_mul(size_of::<T>() as u64);
        if bytes == 0 {
            return Ok(Vec::new());
        }
        check(buffer, bytes)?;
        let staging = match self.staging.take() {
            Some(kept) if kept.size() >= bytes => kept,
            _ => staging(device, bytes),
        };
        let mut encoder = device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, bytes);
        queue.submit([encoder.finish()]);
        let values = map(device, &staging, bytes).await?;
        self.staging = Some(staging);
        Ok(values)
    }
}

/// Checks that the first `bytes` of a buffer can be copied.
fn check(buffer: &wgpu::Buffer, bytes: u64) -> Result<()> {
    let message = if bytes > buffer.size() {
        let held = buffer.size();
        format!("reading back {bytes} bytes of a buffer that has {held}; request fewer")
    } else if !bytes.is_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT) {
        let word = wgpu::COPY_BUFFER_ALIGNMENT;
        format!(
            "reading back {bytes} bytes, which is not a multiple of {word}; request more or fewer"
        )
    } else if !buffer.usage().contains(wgpu::BufferUsages::COPY_SRC) {
        "reading back a buffer that was created without `BufferUsages::COPY_SRC`; create it with this usage"
            .into()
    } else {
        return Ok(());
    };
    Err(Error::Device(message))
}

/// A buffer that the host can map.
pub(crate) fn staging(device: &wgpu::Device, bytes: u64) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("staging"),
        size: bytes,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// Reads the first `bytes` of a staging buffer after all work submitted before.
pub(crate) async fn map<T: bytemuck::Pod>(
    device: &wgpu::Device,
    staging: &wgpu::Buffer,
    bytes: u64,
) -> Result<Vec<T>> {
    let mapped = Arc::new(Mutex::new(Mapped::default()));
    let done = Arc::clone(&mapped);
    // A buffer that was created after the loss of the device is invalid. Mapping it is a validation error, on which wgpu
    // panics outside of an error scope.
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    staging.map_async(wgpu::MapMode::Read, 0..bytes, move |result| {
        if let Ok(mut mapped) = done.lock() {
            mapped.result = Some(result);
            if let Some(waker) = mapped.waker.take() {
                waker.wake();
            }
        }
    });
    let refused = scope.pop();
    let lost = |e: &dyn std::fmt::Display| Error::DeviceLost(format!("reading back: {e}"));
    if let Some(error) = refused.await {
        return Err(lost(&error));
    }
    poll_fn(|context| match mapped.lock() {
        Ok(mut mapped) => match mapped.result.take() {
            Some(result) => Poll::Ready(result.map_err(|e| lost(&e))),
            None => {
                mapped.waker = Some(context.waker().clone());
                Poll::Pending
            }
        },
        Err(e) => Poll::Ready(Err(lost(&e))),
    })
    .await?;
    let view = staging.get_mapped_range(0..bytes).map_err(|e| lost(&e))?;
    let values = bytemuck::pod_collect_to_vec(&view);
    drop(view);
    staging.unmap();
    Ok(values)
}
