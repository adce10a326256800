//! How many steps go to the device at a time.

use std::time::Duration;

/// Long enough to hide what a submission costs, short enough for Ctrl-C and for drivers that end
/// long work.
const TIME: f64 = 0.25;
/// Growth from one batch to the next: a first measurement on a cold device may be far off.
const GROWTH: u64 = 4;

/// Steps a submission, learnt from those before.
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

    /// `steps` took `time`.
    pub fn learn(&mut self, steps: u64, time: Duration) {
        let fit = TIME * steps as f64 / time.as_secs_f64().max(1e-9);
        // A batch that an output cut short says nothing against longer ones.
        let most = GROWTH * self.0.max(steps);
        self.0 = (fit as u64).clamp(1, most);
    }
}
