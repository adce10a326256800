//! Values of several steps in transit from the device to the host.

use crate::{Result, gpu::readback};

/// f32 values of several steps in transit to the host. Staging buffers are reused.
#[derive(Debug, Default)]
pub struct AsyncReadback {
    staging: Vec<wgpu::Buffer>,
    /// The device of the staging buffers, once there is one.
    device: Option<wgpu::Device>,
    /// Steps in flight, each in the staging buffer of the same index.
    steps: Vec<u64>,
    bytes: u64,
}

/// The first `count` f32 values of a buffer, to be copied to the host.
#[derive(Clone, Copy, Debug)]
pub struct Copied<'a> {
    /// A buffer with usage `COPY_SRC`.
    pub buffer: &'a wgpu::Buffer,
    /// Number of f32 values.
    pub count: usize,
}

impl AsyncReadback {
    /// Records a copy at the end of the step `step`. The count must not change while copies are in flight.
    pub fn record(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        source: Copied<'_>,
        step: u64,
    ) {
        self.bytes = 4 * source.count as u64;
        self.device.get_or_insert_with(|| device.clone());
        let index = self.steps.len();
        self.steps.push(step);
        if self.bytes == 0 {
            return;
        }
        if index == self.staging.len() {
            self.staging.push(readback::staging(device, self.bytes));
        }
        let staging = &mut self.staging[index];
        if staging.size() < self.bytes {
            *staging = readback::staging(device, self.bytes);
        }
        encoder.copy_buffer_to_buffer(source.buffer, 0, staging, 0, self.bytes);
    }

    /// The values of each recorded step, in order. Call it after the submission of the copies; the caller polls the
    /// device.
    ///
    /// # Errors
    /// [`crate::Error::DeviceLost`] if the buffers cannot be mapped.
    pub async fn finish(&mut self) -> Result<Vec<(u64, Vec<f32>)>> {
        let mut all = Vec::new();
        for (index, step) in std::mem::take(&mut self.steps).into_iter().enumerate() {
            let values = match (&self.device, self.bytes) {
                (Some(device), bytes) if bytes > 0 => {
                    readback::map(device, &self.staging[index], bytes).await?
                }
                _ => Vec::new(),
            };
            all.push((step, values));
        }
        Ok(all)
    }

    /// Discards the copies in flight.
    pub fn discard(&mut self) {
        self.steps.clear();
    }
}
