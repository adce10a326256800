//! Speed of a run, number of steps per submission, and times of their phases. The first steps, in which drivers compile
//! the kernels, are timed separately.

use riprap::simulation::Phase;
use std::{fmt::Write, time::Duration};

/// Steps that are timed separately: an in-place lattice has kernels for even and for odd steps, and drivers compile each at
/// its first dispatch.
const FIRST: u64 = 2;

/// Steps and the time that they took, without output.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timed {
    /// Steps of the scene.
    pub steps: u64,
    /// Steps of its fluid: free water takes several per step of the scene.
    pub fluid_steps: u64,
    /// Duration; the device is idle at both ends.
    pub time: Duration,
}

impl Timed {
    /// `count` per duration, 1/s.
    pub fn rate(&self, count: u64) -> f64 {
        count as f64 / self.time.as_secs_f64().max(1e-9)
    }

    fn add(&mut self, other: Self) {
        self.steps += other.steps;
        self.fluid_steps += other.fluid_steps;
        self.time += other.time;
    }
}

/// The steps of a run so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Throughput {
    first: Timed,
    rest: Timed,
}

impl Throughput {
    /// Adds a batch of steps.
    pub fn add(&mut self, batch: Timed) {
        match self.first.steps < FIRST {
            true => self.first.add(batch),
            false => self.rest.add(batch),
        }
    }

    /// All steps.
    pub fn whole(&self) -> Timed {
        let mut whole = self.first;
        whole.add(self.rest);
        whole
    }

    /// The steps used for speeds: all except those in which kernels were compiled, or all if there are no others.
    pub fn warm(&self) -> Timed {
        match self.rest.steps {
            0 => self.first,
            _ => self.rest,
        }
    }
}

/// Duration of a batch, s: long enough to hide the cost of a submission, short enough for Ctrl-C and for drivers that end
/// long work.
const BATCH_TIME: f64 = 0.25;
/// Growth from one batch to the next: a first measurement on a cold device may be far off.
const GROWTH: u64 = 4;

/// Steps per submission, adapted to the duration of those before.
#[derive(Clone, Copy, Debug)]
pub struct Batch(u64);

impl Batch {
    pub fn new() -> Self {
        Self(1)
    }

    /// Steps to submit.
    pub fn steps(&self) -> u64 {
        self.0
    }

    /// Adapts the batch to `steps` that took `time`.
    pub fn learn(&mut self, steps: u64, time: Duration) {
        let fit = BATCH_TIME * steps as f64 / time.as_secs_f64().max(1e-9);
        // A batch that output cut short is no reason against longer ones.
        let most = GROWTH * self.0.max(steps);
        self.0 = (fit as u64).clamp(1, most);
    }
}

/// One line per phase: its name, its count and its times.
pub fn phase_table(phases: &[Phase]) -> String {
    let mut text = format!(
        "{:20} {:>10} {:>12} {:>12}\n",
        "phase", "times", "mean, ms", "total, s"
    );
    for Phase {
        name,
        count,
        seconds,
    } in phases
    {
        let mean = 1e3 * seconds / (*count).max(1) as f64;
        // Writing to a `String` cannot fail.
        let _ = writeln!(text, "{name:20} {count:>10} {mean:>12.4} {seconds:>12.4}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn batch(steps: u64, milliseconds: u64) -> Timed {
        Timed {
            steps,
            fluid_steps: 3 * steps,
            time: Duration::from_millis(milliseconds),
        }
    }

    /// A first step of 2 s and 50 of 10 ms each: 100 steps per second, not 20.
    #[test]
    fn compilation_does_not_count_in_speeds() {
        let mut throughput = Throughput::default();
        throughput.add(batch(1, 2000));
        // No other steps yet.
        assert_eq!(throughput.warm(), batch(1, 2000));
        throughput.add(batch(1, 1000));
        assert_eq!(throughput.warm(), batch(2, 3000));
        throughput.add(batch(10, 100));
        throughput.add(batch(40, 400));
        assert_eq!(throughput.warm(), batch(50, 500));
        assert_eq!(throughput.whole(), batch(52, 3500));
        let warm = throughput.warm();
        assert!((warm.rate(warm.steps) - 100.0).abs() < 1e-9);
        assert!((warm.rate(warm.fluid_steps) - 300.0).abs() < 1e-9);
    }

    #[test]
    fn a_phase_has_its_mean_and_its_total() {
        let phase = Phase {
            name: "bulk".into(),
            count: 4,
            seconds: 0.01,
        };
        let text = phase_table(&[phase]);
        let line: Vec<_> = text.lines().nth(1).unwrap().split_whitespace().collect();
        assert_eq!(line, ["bulk", "4", "2.5000", "0.0100"]);
    }
}
