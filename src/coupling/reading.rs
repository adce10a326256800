//! A copy that the device makes while it goes on, and the host waits for.

use crate::{Result, readback};

/// Numbers on their way from the device. The staging buffer is kept for the next ones.
#[derive(Debug, Default)]
pub struct Reading {
    staging: Option<wgpu::Buffer>,
    bytes: u64,
    pending: bool,
}

impl Reading {
    /// Records the copy of the first `count` f32 of `buffer`.
    pub fn record(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        buffer: &wgpu::Buffer,
        count: usize,
    ) {
        self.bytes = 4 * count as u64;
        if self.bytes == 0 {
            return;
        }
        let kept = self.staging.take().filter(|kept| kept.size() >= self.bytes);
        let staging = kept.unwrap_or_else(|| readback::staging(device, self.bytes));
        encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, self.bytes);
        self.staging = Some(staging);
        self.pending = true;
    }

    /// Whether numbers are on their way.
    pub fn is_pending(&self) -> bool {
        self.pending
    }

    /// The numbers, once what was submitted with the copy is done; somebody must poll the device.
    ///
    /// # Errors
    /// [`crate::Error::DeviceLost`] if they cannot be mapped.
    pub async fn finish(&mut self) -> Result<Vec<f32>> {
        self.pending = false;
        match &self.staging {
            Some(staging) if self.bytes > 0 => readback::map(staging, self.bytes).await,
            _ => Ok(Vec::new()),
        }
    }
}
