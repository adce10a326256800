//! GPU time of compute passes, on devices that have timestamps.

use crate::{Result, gpu::readback::Readback};

/// Times compute passes by a pair of timestamps each.
///
/// A round is: [`Timer::pass`] for each pass, [`Timer::resolve`] at the end of the encoder, submit,
/// [`Timer::read`]. Where the device was made without `Features::TIMESTAMP_QUERY` there is no timer,
/// and [`pass`] gives plain descriptors that cost nothing.
#[derive(Debug)]
pub struct Timer {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    seconds_a_tick: f64,
    capacity: usize,
    labels: Vec<String>,
    readback: Readback,
}

impl Timer {
    /// A timer of up to `capacity` passes a round; `None` on a device without timestamps.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, capacity: u32) -> Option<Self> {
        if !device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return None;
        }
        let capacity = capacity.clamp(1, wgpu::QUERY_SET_MAX_QUERIES / 2);
        let queries = device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("timer"),
            ty: wgpu::QueryType::Timestamp,
            count: 2 * capacity,
        });
        let resolved = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("timestamps"),
            size: 2 * u64::from(capacity) * u64::from(wgpu::QUERY_SIZE),
            usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        Some(Self {
            queries,
            resolved,
            seconds_a_tick: f64::from(queue.get_timestamp_period()) * 1e-9,
            capacity: capacity as usize,
            labels: Vec::new(),
            readback: Readback::default(),
        })
    }

    /// The descriptor of a pass that is timed under `label`, or of a plain one once the capacity is
    /// used up.
    pub fn pass<'a>(&'a mut self, label: &'a str) -> wgpu::ComputePassDescriptor<'a> {
        let n = self.labels.len();
        let writes = (n < self.capacity).then(|| {
            self.labels.push(label.into());
            wgpu::ComputePassTimestampWrites {
                query_set: &self.queries,
                beginning_of_pass_write_index: Some(2 * n as u32),
                end_of_pass_write_index: Some(2 * n as u32 + 1),
            }
        });
        wgpu::ComputePassDescriptor {
            label: Some(label),
            timestamp_writes: writes,
        }
    }

    /// Records the end of a round, behind its passes.
    pub fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        let used = 2 * self.labels.len() as u32;
        if used > 0 {
            encoder.resolve_query_set(&self.queries, 0..used, &self.resolved, 0);
        }
    }

    /// Label and seconds of each pass of the round that was submitted last, and begins a new one.
    ///
    /// # Errors
    /// [`crate::Error::DeviceLost`] if the device does not give the timestamps back.
    pub async fn read(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
    ) -> Result<Vec<(String, f64)>> {
        let labels = std::mem::take(&mut self.labels);
        let count = 2 * labels.len();
        let ticks: Vec<u64> = self
            .readback
            .read(device, queue, &self.resolved, count)
            .await?;
        let seconds = ticks.chunks_exact(2).map(|pair| {
            // A clock that was reset between the two gives nothing.
            pair[1].saturating_sub(pair[0]) as f64 * self.seconds_a_tick
        });
        Ok(labels.into_iter().zip(seconds).collect())
    }
}

/// The descriptor of a pass: timed under `label` if there is a timer.
pub fn pass<'a>(timer: Option<&'a mut Timer>, label: &'a str) -> wgpu::ComputePassDescriptor<'a> {
    match timer {
        Some(timer) => timer.pass(label),
        None => wgpu::ComputePassDescriptor {
            label: Some(label),
            timestamp_writes: None,
        },
    }
}
