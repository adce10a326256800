//! What the steps of a run take, by the clock on the wall and of the CPU.

use cpu_time::ProcessTime;
use std::time::Instant;

/// Steps at the start of a run that are not timed: drivers compile at the first dispatch, boundaries begin with the
/// second step, and even and odd ones have kernels of their own.
pub const WARM_UP: u64 = 4;

/// Time of steps alone: without read-outs and the warm-up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spent {
    /// By the clock on the wall, s.
    pub wall: f64,
    /// Of all threads of this process together, s.
    pub cpu: f64,
}

impl Spent {
    /// What `share` times as many steps take.
    pub fn scaled(self, share: f64) -> Self {
        Self {
            wall: share * self.wall,
            cpu: share * self.cpu,
        }
    }
}

/// A stretch under way.
#[derive(Debug)]
pub struct Stopwatch {
    wall: Instant,
    cpu: ProcessTime,
}

impl Stopwatch {
    /// Begins a stretch.
    pub fn start() -> Self {
        Self {
            wall: Instant::now(),
            cpu: ProcessTime::now(),
        }
    }

    /// Adds the stretch that ends here.
    pub fn stop(self, spent: &mut Spent) {
        spent.wall += self.wall.elapsed().as_secs_f64();
        spent.cpu += self.cpu.elapsed().as_secs_f64();
    }
}
