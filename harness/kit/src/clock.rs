//! Timing of work by wall clock, CPU time and GPU timestamps, and the growth of its cost.

use super::gpu;
use super::subject::Subject;
use cpu_time::ProcessTime;
use riprap::{Error, gpu::timer::Timer, wgpu};
use std::{
    ops::AddAssign,
    time::{Duration, Instant},
};

/// Timeout for a driver that hangs.
pub const PATIENCE: Duration = Duration::from_secs(300);

/// Time spent on some work, s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spent {
    /// Wall-clock time.
    pub wall: f64,
    /// CPU time of all threads together.
    pub cpu: f64,
}

impl Spent {
    /// More than any measured time.
    pub const MOST: Self = Self {
        wall: f64::INFINITY,
        cpu: f64::INFINITY,
    };

    /// The time of `share` times as much work.
    pub fn scaled(self, share: f64) -> Self {
        Self {
            wall: share * self.wall,
            cpu: share * self.cpu,
        }
    }

    /// The lower of each: other processes on the machine can only add time.
    pub fn lower(self, other: Self) -> Self {
        Self {
            wall: self.wall.min(other.wall),
            cpu: self.cpu.min(other.cpu),
        }
    }
}

impl AddAssign for Spent {
    fn add_assign(&mut self, other: Self) {
        self.wall += other.wall;
        self.cpu += other.cpu;
    }
}

/// A running measurement.
#[derive(Debug)]
pub struct Stopwatch {
    wall: Instant,
    cpu: ProcessTime,
}

impl Stopwatch {
    /// Starts a measurement.
    pub fn start() -> Self {
        Self {
            wall: Instant::now(),
            cpu: ProcessTime::now(),
        }
    }

    /// The time since the start, for all threads of this process.
    pub fn spent(&self) -> Spent {
        Spent {
            wall: self.wall.elapsed().as_secs_f64(),
            cpu: self.cpu.elapsed().as_secs_f64(),
        }
    }
}

/// Time of one repetition, s.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// Wall-clock and CPU time, submission and waiting included.
    pub spent: Spent,
    /// Time between GPU timestamps around the pass.
    pub device: Option<f64>,
    /// Time from which speeds are computed: on a software adapter CPU time over the number of cores, which other processes do
    /// not distort; GPU time elsewhere.
    pub basis: f64,
}

/// A device and the timers available on it.
pub struct Clock {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    timer: Option<Timer>,
    /// Cores of a software adapter.
    cores: Option<f64>,
}

impl Clock {
    /// A clock for a device; `software` if it computes on the CPU.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, software: bool) -> Self {
        Self {
            timer: Timer::new(device, queue, 1),
            cores: software.then(|| cores() as f64),
            device: device.clone(),
            queue: queue.clone(),
        }
    }

    /// Waits until the device has done what was submitted.
    pub fn wait(&self) -> Result<(), Error> {
        let waited = self.device.poll(wgpu::PollType::Wait {
            submission_index: None,
            timeout: Some(PATIENCE),
        });
        waited.map_or_else(|e| Err(Error::DeviceLost(e.to_string())), |_| Ok(()))
    }

    /// The mean time of one repetition, from `turns` repetitions in one submission.
    pub fn run(&mut self, subject: &mut Subject<'_>, turns: u32) -> Result<Turn, Error> {
        let watch = Stopwatch::start();
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let timed = subject.record(&mut encoder, self.timer.as_mut(), turns);
        if let Some(timer) = &self.timer {
            timer.resolve(&mut encoder);
        }
        self.queue.submit([encoder.finish()]);
        self.wait()?;
        let spent = watch.spent().scaled(1.0 / f64::from(turns));
        let device = match &mut self.timer {
            Some(timer) if timed => {
                let read = timer.read(&self.device, &self.queue);
                let times = gpu::drive(&self.device, PATIENCE, "the timestamps", read)??;
                times.first().map(|(_, seconds)| seconds / f64::from(turns))
            }
            _ => None,
        };
        let basis = match device {
            Some(device) if self.cores.is_none() => device,
            _ => self.basis(spent),
        };
        Ok(Turn {
            spent,
            device,
            basis,
        })
    }

    /// The time that `work` takes; [`Clock::basis`] converts it for speeds.
    pub fn time<E>(&self, work: impl FnOnce() -> Result<(), E>) -> Result<Spent, E> {
        let watch = Stopwatch::start();
        work()?;
        Ok(watch.spent())
    }

    /// CPU time over the number of cores on a software adapter, else wall-clock time.
    pub fn basis(&self, spent: Spent) -> f64 {
        match self.cores {
            Some(cores) => spent.cpu / cores,
            None => spent.wall,
        }
    }
}

/// Cores that this process may use.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// The exponent p of cost ∝ countᵖ by least squares on the logarithms of (count, cost); `None` without two different
/// counts.
pub fn exponent(points: &[(f64, f64)]) -> Option<f64> {
    let n = points.len() as f64;
    let logs = || points.iter().map(|(count, cost)| (count.ln(), cost.ln()));
    let x = logs().map(|p| p.0).sum::<f64>() / n;
    let y = logs().map(|p| p.1).sum::<f64>() / n;
    let spread: f64 = logs().map(|p| (p.0 - x).powi(2)).sum();
    let covariance: f64 = logs().map(|p| (p.0 - x) * (p.1 - y)).sum();
    (spread > 0.0).then(|| covariance / spread)
}
