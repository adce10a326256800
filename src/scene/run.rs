//! How long to compute.

use schemars::JsonSchema;
use serde::Deserialize;

use super::Scene;
use super::rules::{interval, positive, refuse};
use crate::error::Result;
use crate::units::Units;

/// Length of the run. Exactly one of `duration` and `steps` is given.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// Simulated time, s.
    pub duration: Option<f64>,
    /// Number of time steps.
    pub steps: Option<u64>,
    /// Time between checkpoints, s; each takes the place of the one before. Default a tenth of the run, in the
    /// first tenth a hundredth, so that a run that diverges leaves a good state; more for states larger than 0.4 GB.
    pub checkpoint_every: Option<f64>,
}

impl Run {
    /// Number of time steps of the run.
    pub fn step_count(&self, units: &Units) -> u64 {
        self.count(units.time_step)
    }

    /// Number of steps of `time_step` s in the run.
    pub fn count(&self, time_step: f64) -> u64 {
        match (self.steps, self.duration) {
            (Some(steps), _) => steps,
            (None, Some(duration)) => (duration / time_step).round().max(1.0) as u64,
            (None, None) => 0,
        }
    }

    /// Simulated time of the run in steps of `time_step` s, s.
    pub fn length(&self, time_step: f64) -> f64 {
        self.count(time_step) as f64 * time_step
    }

    /// Simulated time of the run, s.
    pub fn duration(&self, units: &Units) -> f64 {
        self.length(units.time_step)
    }
}

impl Scene {
    pub(super) fn check_run(&self) -> Result<()> {
        match (self.run.duration, self.run.steps) {
            (Some(_), Some(_)) => refuse(
                "run.steps",
                "the run has both `duration` and `steps`; keep one of them",
            ),
            (None, None) => refuse(
                "run",
                "the run has no end; give `duration` (s) or `steps` (a whole number)",
            ),
            (Some(duration), None) => positive("run.duration", duration, "s"),
            (None, Some(0)) => refuse("run.steps", "the run has no steps; give at least 1"),
            (None, Some(_)) => Ok(()),
        }?;
        interval("run.checkpoint_every", self.run.checkpoint_every)
    }
}
