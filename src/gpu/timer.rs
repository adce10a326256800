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

/// Passes that are timed between two [`Phases::collect`].
const PASSES: u32 = 2048;

/// Times of the phases of a step, by name, over a run: those of passes by timestamps, those of the host by its clock. A
/// device without timestamps gives no times of passes.
#[derive(Debug)]
pub struct Phases {
    timer: Option<Timer>,
    times: Vec<Phase>,
}

/// A phase of a step.
#[derive(Clone, Debug, PartialEq)]
pub struct Phase {
    /// Its name.
    pub name: String,
    /// How often it was timed.
    pub count: u64,
    /// All times together, s.
    pub seconds: f64,
}

impl Phases {
    /// Nothing is timed yet.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        Self {
            timer: Timer::new(device, queue, PASSES),
            times: Vec::new(),
        }
    }

    /// Records the end of the timed passes, behind the last of them.
    pub fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        if let Some(timer) = &self.timer {
            timer.resolve(encoder);
        }
    }

    /// Adds the times of the passes that have been submitted since the last call, at most 2048 of them.
    ///
    /// # Errors
    /// [`crate::Error::DeviceLost`] if the device does not give the timestamps back.
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

/// Begins a pass: timed as the phase `name` if phases are timed.
pub fn begin_pass<'e>(
    phases: &mut Option<Phases>,
    encoder: &'e mut wgpu::CommandEncoder,
    name: &str,
) -> wgpu::ComputePass<'e> {
    let timer = phases.as_mut().and_then(|phases| phases.timer.as_mut());
    encoder.begin_compute_pass(&pass(timer, name))
}
