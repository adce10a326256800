//! How long to compute.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::units::Units;

/// Length of the run. Exactly one of `duration` and `steps` is given.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// Simulated time, s.
    pub duration: Option<f64>,
    /// Number of time steps.
    pub steps: Option<u64>,
    /// Time between checkpoints, s. Default none.
    pub checkpoint_every: Option<f64>,
}

impl Run {
    /// Number of time steps of the run.
    pub fn step_count(&self, units: &Units) -> u64 {
        match (self.steps, self.duration) {
            (Some(steps), _) => steps,
            (None, Some(duration)) => units.steps(duration),
            (None, None) => 0,
        }
    }

    /// Simulated time of the run, s.
    pub fn duration(&self, units: &Units) -> f64 {
        self.step_count(units) as f64 * units.time_step
    }
}
