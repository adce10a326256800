//! What a piece of work takes: by the clock on the wall, of the CPU, and between timestamps of a GPU; and how a cost grows.

use super::gpu;
use super::subject::Subject;
use cpu_time::ProcessTime;
use riprap::{Error, gpu::timer::Timer, wgpu};
use std::{
    ops::AddAssign,
    time::{Duration, Instant},
};

/// A hanging driver is given up after this.
pub const PATIENCE: Duration = Duration::from_secs(300);

/// Seconds of a piece of work.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spent {
    /// By the clock on the wall.
    pub wall: f64,
    /// Of the CPU, all threads that worked together.
    pub cpu: f64,
}

impl Spent {
    /// More than any.
    pub const MOST: Self = Self {
        wall: f64::INFINITY,
        cpu: f64::INFINITY,
    };

    /// What `share` times as much work takes.
    pub fn scaled(self, share: f64) -> Self {
        Self {
            wall: share * self.wall,
            cpu: share * self.cpu,
        }
    }

    /// The lower of each: others on the machine can only add.
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

/// Work under way.
#[derive(Debug)]
pub struct Stopwatch {
    wall: Instant,
    cpu: ProcessTime,
}

impl Stopwatch {
    /// Begins.
    pub fn start() -> Self {
        Self {
            wall: Instant::now(),
            cpu: ProcessTime::now(),
        }
    }

    /// What was spent since the start, by all threads of this process.
    pub fn spent(&self) -> Spent {
        Spent {
            wall: self.wall.elapsed().as_secs_f64(),
            cpu: self.cpu.elapsed().as_secs_f64(),
        }
    }
}

/// Seconds of one turn.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// Submission and waiting included.
    pub spent: Spent,
    /// Between GPU timestamps around the pass.
    pub device: Option<f64>,
    /// What speeds are made from: CPU time over the cores on a software adapter, which a busy
    /// machine does not distort; GPU time elsewhere.
    pub basis: f64,
}

/// A device and its ways to tell time.
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
    /// A clock for a device; `software` says that it computes on the CPU.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, software: bool) -> Self {
        Self {
            timer: Timer::new(device, queue, 1),
            cores: software.then(|| cores() as f64),
            device: device.clone(),
            queue: queue.clone(),
        }
    }

    /// Waits until the device has done what was submitted.
    ///
    /// # Errors
    /// If the device is lost or silent.
    pub fn wait(&self) -> Result<(), Error> {
        let waited = self.device.poll(wgpu::PollType::Wait {
            submission_index: None,
            timeout: Some(PATIENCE),
        });
        waited.map_or_else(|e| Err(Error::DeviceLost(e.to_string())), |_| Ok(()))
    }

    /// What a turn takes, from `turns` of them in one submission.
    ///
    /// # Errors
    /// If the device is lost or silent.
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

    /// What `work` takes; [`Clock::basis`] has what speeds are made from.
    ///
    /// # Errors
    /// Those of `work`.
    pub fn time<E>(&self, work: impl FnOnce() -> Result<(), E>) -> Result<Spent, E> {
        let watch = Stopwatch::start();
        work()?;
        Ok(watch.spent())
    }

    /// CPU time over the cores on a software adapter, else time by the clock on the wall.
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

/// The exponent p of cost ∝ countᵖ by least squares on the logarithms of (count, cost); none without two
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
