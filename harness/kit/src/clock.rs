//! Running something a number of times and seeing what it took.

use super::gpu;
use super::subject::Subject;
use cpu_time::ProcessTime;
use riprap::{Error, gpu::timer::Timer, wgpu};
use std::time::{Duration, Instant};

/// A hanging driver is given up after this.
const PATIENCE: Duration = Duration::from_secs(300);

/// Seconds of one turn.
#[derive(Clone, Copy, Debug)]
pub struct Spent {
    /// By the clock on the wall, submission and waiting included.
    pub wall: f64,
    /// Between GPU timestamps around the pass.
    pub device: Option<f64>,
    /// Of all threads of this process together.
    pub cpu: f64,
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

    /// What a turn takes, from `turns` of them in one submission.
    ///
    /// # Errors
    /// If the device is lost or silent.
    pub fn run(&mut self, subject: &mut Subject<'_>, turns: u32) -> Result<Spent, Error> {
        let (start, cpu) = (Instant::now(), ProcessTime::now());
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let timed = subject.record(&mut encoder, self.timer.as_mut(), turns);
        if let Some(timer) = &self.timer {
            timer.resolve(&mut encoder);
        }
        self.queue.submit([encoder.finish()]);
        let waited = self.device.poll(wgpu::PollType::Wait {
            submission_index: None,
            timeout: Some(PATIENCE),
        });
        waited.map_err(|e| Error::DeviceLost(e.to_string()))?;
        let turns = f64::from(turns);
        let (wall, cpu) = (
            start.elapsed().as_secs_f64() / turns,
            cpu.elapsed().as_secs_f64() / turns,
        );
        let device = match &mut self.timer {
            Some(timer) if timed => {
                let read = timer.read(&self.device, &self.queue);
                let times = gpu::drive(&self.device, PATIENCE, "the timestamps", read)??;
                times.first().map(|(_, seconds)| seconds / turns)
            }
            _ => None,
        };
        let basis = match self.cores {
            Some(cores) => cpu / cores,
            None => device.unwrap_or(wall),
        };
        Ok(Spent {
            wall,
            device,
            cpu,
            basis,
        })
    }
}

impl Clock {
    /// Seconds that `work` takes by the clock on the wall, and those that speeds are made from.
    ///
    /// # Errors
    /// Those of `work`.
    pub fn time(&self, work: impl FnOnce() -> Result<(), Error>) -> Result<[f64; 2], Error> {
        let (start, cpu) = (Instant::now(), ProcessTime::now());
        work()?;
        let wall = start.elapsed().as_secs_f64();
        let basis = match self.cores {
            Some(cores) => cpu.elapsed().as_secs_f64() / cores,
            None => wall,
        };
        Ok([wall, basis])
    }
}

/// Cores that this process may use.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}
