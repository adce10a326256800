//! Copies that the device makes while it goes on, and the host waits for.

use crate::{Result, readback};

/// Numbers of some steps on their way from the device. The staging buffers are kept for the next ones.
#[derive(Debug, Default)]
pub struct Reading {
    staging: Vec<wgpu::Buffer>,
    /// Theirs, once there is one.
    device: Option<wgpu::Device>,
    /// Steps whose numbers are on their way, each in the staging buffer of its place.
    steps: Vec<u64>,
    bytes: u64,
}

impl Reading {
    /// Records the copy of the first `count` f32 of `buffer` at the end of the step `step`; `count` stays the
    /// same until they have come.
    pub fn record(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        (buffer, count): (&wgpu::Buffer, usize),
        step: u64,
    ) {
        self.bytes = 4 * count as u64;
        self.device.get_or_insert_with(|| device.clone());
        let place = self.steps.len();
        self.steps.push(step);
        if self.bytes == 0 {
            return;
        }
        if place == self.staging.len() {
            self.staging.push(readback::staging(device, self.bytes));
        }
        let staging = &mut self.staging[place];
        if staging.size() < self.bytes {
            *staging = readback::staging(device, self.bytes);
        }
        encoder.copy_buffer_to_buffer(buffer, 0, staging, 0, self.bytes);
    }

    /// The numbers of each step in their order, once what was submitted with the copies is done; somebody
    /// must poll the device.
    ///
    /// # Errors
    /// [`crate::Error::DeviceLost`] if they cannot be mapped.
    pub async fn finish(&mut self) -> Result<Vec<(u64, Vec<f32>)>> {
        let mut all = Vec::new();
        for (place, step) in std::mem::take(&mut self.steps).into_iter().enumerate() {
            let numbers = match (&self.device, self.bytes) {
                (Some(device), bytes) if bytes > 0 => {
                    readback::map(device, &self.staging[place], bytes).await?
                }
                _ => Vec::new(),
            };
            all.push((step, numbers));
        }
        Ok(all)
    }

    /// Lets go of what is on its way.
    pub fn forget(&mut self) {
        self.steps.clear();
    }
}
