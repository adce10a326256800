//! One core, and what work takes on it.

use cpu_time::{ProcessTime, ThreadTime};
use riprap::{Error, Result};
use std::time::Instant;

/// Seconds that one call takes.
#[derive(Clone, Copy, Debug)]
pub struct Cost {
    /// CPU time, of all threads that worked.
    pub cpu: f64,
    /// By the clock on the wall.
    pub wall: f64,
}

impl Cost {
    /// More than any.
    pub const NONE: Self = Self {
        cpu: f64::INFINITY,
        wall: f64::INFINITY,
    };

    /// None yet.
    pub const ZERO: Self = Self {
        cpu: 0.0,
        wall: 0.0,
    };

    /// Both together.
    pub fn with(self, other: Self) -> Self {
        Self {
            cpu: self.cpu + other.cpu,
            wall: self.wall + other.wall,
        }
    }

    /// What one of `calls` took, if all took this.
    pub fn of_each(self, calls: usize) -> Self {
        Self {
            cpu: self.cpu / calls as f64,
            wall: self.wall / calls as f64,
        }
    }

    /// The lower of each: others on the machine can only add.
    pub fn lower(self, other: Self) -> Self {
        Self {
            cpu: self.cpu.min(other.cpu),
            wall: self.wall.min(other.wall),
        }
    }
}

/// A thread of its own, on which parallel loops run one after the other.
pub struct Core(rayon::ThreadPool);

impl Core {
    /// A core.
    ///
    /// # Errors
    /// If there is no thread to be had.
    pub fn new() -> Result<Self> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        pool.map(Self)
            .map_err(|e| Error::argument("threads", e.to_string()))
    }

    /// What `work` takes on the core.
    ///
    /// # Errors
    /// Those of `work`.
    pub fn time<T: Send>(&self, work: impl FnOnce() -> Result<T> + Send) -> Result<(T, Cost)> {
        self.0.install(|| {
            let (wall, cpu) = (Instant::now(), ThreadTime::now());
            let made = work()?;
            let cost = Cost {
                cpu: cpu.elapsed().as_secs_f64(),
                wall: wall.elapsed().as_secs_f64(),
            };
            Ok((made, cost))
        })
    }
}

/// What `work` takes on all cores.
///
/// # Errors
/// Those of `work`.
pub fn time_on_all<T>(work: impl FnOnce() -> Result<T>) -> Result<(T, Cost)> {
    let (wall, cpu) = (Instant::now(), ProcessTime::now());
    let made = work()?;
    let cost = Cost {
        cpu: cpu.elapsed().as_secs_f64(),
        wall: wall.elapsed().as_secs_f64(),
    };
    Ok((made, cost))
}
