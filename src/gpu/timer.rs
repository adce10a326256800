//! GPU time of compute passes, on devices with timestamps.

use crate::{Result, gpu::readback::Readback};

/// Times each compute pass by a pair of timestamps.
///
/// A round consists of [`Timer::pass`] for each pass, [`Timer::resolve`] at the end of the encoder, submission, and
/// [`Timer::read`]. A device without `Features::TIMESTAMP_QUERY` has no timer; [`pass`] then returns plain descriptors at no
/// cost.
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
    /// A timer of up to `capacity` passes per round; `None` on a device without timestamps.
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

    /// The descriptor of a pass that is timed under `label`; a plain descriptor when the capacity is exhausted.
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

    /// Records the end of a round, after its passes.
    pub fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        let used = 2 * self.labels.len() as u32;
        if used > 0 {
            encoder.resolve_query_set(&self.queries, 0..used, &self.resolved, 0);
        }
    }

    /// Returns label and seconds of each pass of the last submitted round, and begins a new round.
    ///
    /// # Errors
    /// [`crate::Error::DeviceLost`] if the timestamps cannot be read back.
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
            // Zero if the clock was reset between the two timestamps.
            pair[1].saturating_sub(pair[0]) as f64 * self.seconds_a_tick
        });
        Ok(labels.into_iter().zip(seconds).collect())
    }
}

/// The descriptor of a pass, timed under `label` if there is a timer.
pub fn pass<'a>(timer: Option<&'a mut Timer>, label: &'a str) -> wgpu::ComputePassDescriptor<'a> {
    match timer {
        Some(timer) => timer.pass(label),
        None => wgpu::ComputePassDescriptor {
            label: Some(label),
            timestamp_writes: None,
        },
    }
}

/// Largest number of timed passes between two calls of [`Phases::collect`].
const PASSES: u32 = 2048;

/// Times of the phases of a step, by name, over a run. Passes are timed by timestamps, host phases by the clock of the host.
/// Without timestamps there are no times of passes.
#[derive(Debug)]
pub struct Phases {
    timer: Option<Timer>,
    times: Vec<Phase>,
}

/// A phase of a step.
#[derive(Clone, Debug, PartialEq)]
pub struct Phase {
    /// Name of the phase.
    pub name: String,
    /// Number of measurements.
    pub count: u64,
    /// Sum of the times, s.
    pub seconds: f64,
}

impl Phases {
    /// Phases without any times yet.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        Self {
            timer: Timer::new(device, queue, PASSES),
            times: Vec::new(),
        }
    }

    /// Records the end of the timed passes, after the last one.
    pub fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        if let Some(timer) = &self.timer {
            timer.resolve(encoder);
        }
    }

    /// Adds the times of the passes that have been submitted since the last call, at most 2048.
    ///
    /// # Errors
    /// [`crate::Error::DeviceLost`] if the timestamps cannot be read back.
    pub async fn collect(&mut self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<()> {
        let Some(timer) = &mut self.timer else {
            return Ok(());
        };
        for (name, seconds) in timer.read(device, queue).await? {
            self.add(&name, seconds);
        }
        Ok(())
    }

    /// Adds a time (s) of the phase `name`.
    pub fn add(&mut self, name: &str, seconds: f64) {
        let known = self.times.iter().position(|phase| phase.name == name);
        let at = known.unwrap_or_else(|| {
            self.times.push(Phase {
                name: name.into(),
                count: 0,
                seconds: 0.0,
            });
            self.times.len() - 1
        });
        self.times[at].count += 1;
        self.times[at].seconds += seconds;
    }

    /// The phases in the order in which they first ran.
    pub fn times(&self) -> &[Phase] {
        &self.times
    }
}

/// Begins a pass, timed as the phase `name` if phases are timed.
pub fn begin_pass<'e>(
    phases: &mut Option<Phases>,
    encoder: &'e mut wgpu::CommandEncoder,
    name: &str,
) -> wgpu::ComputePass<'e> {
    let timer = phases.as_mut().and_then(|phases| phases.timer.as_mut());
    encoder.begin_compute_pass(&pass(timer, name))
}
