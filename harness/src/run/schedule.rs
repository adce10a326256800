//! When something is due.

/// The steps nearest to the multiples of an interval, from 0 on, and the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schedule {
    /// Interval in steps, at least 1 and seldom whole: rounding the multiples keeps them from
    /// drifting.
    every: Option<f64>,
    last: u64,
}

impl Schedule {
    /// Each `every` seconds, if given, of steps of `time_step` s, and at the step `last`.
    pub fn new(every: Option<f64>, time_step: f64, last: u64) -> Self {
        let every = every.map(|every| (every / time_step).max(1.0));
        Self { every, last }
    }

    /// Whether `step` is one of its steps.
    pub fn due(&self, step: u64) -> bool {
        let multiple = |every: f64| {
            let nearest = (step as f64 / every).round();
            (nearest * every).round() as u64 == step
        };
        step == self.last || self.every.is_some_and(multiple)
    }

    /// The first of its steps after `step`; the last one when there is none.
    pub fn next(&self, step: u64) -> u64 {
        let Some(every) = self.every else {
            return self.last;
        };
        let passed = (step as f64 / every).floor();
        // Rounding down may make the next multiple this very step.
        let candidates = [1.0, 2.0].map(|more| ((passed + more) * every).round() as u64);
        let found = candidates.into_iter().find(|next| *next > step);
        found.map_or(self.last, |next| next.min(self.last))
    }
}
