//! Length of a run.

use schemars::JsonSchema;
use serde::Deserialize;

use super::Scene;
use super::rules::{interval, positive, refuse};
use crate::error::Result;
use crate::gpu::Processor;
use crate::units::Units;

/// Longest simulated time, s: thirty thousand years. More is a mistake of units, and the number of steps would overflow.
const LONGEST: f64 = 1e12;

/// Length of the run. Exactly one of `duration` and `steps` is given.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Run {
    /// Simulated time, s.
    pub duration: Option<f64>,
    /// Number of time steps.
    pub steps: Option<u64>,
    /// Time between checkpoints, s; each replaces the previous one. Default a tenth of the run, but a hundredth during the
    /// first tenth, so that a run that diverges leaves a good state; more for states larger than 0.4 GB.
    pub checkpoint_every: Option<f64>,
    /// Kind of processor for which the kernels are built. Default `auto`.
    pub kernels: Kernels,
}

/// Kind of processor for which the kernels are built; results agree up to rounding by the order of sums.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Kernels {
    /// The kind of the adapter.
    #[default]
    Auto,
    /// CPUs, used by software adapters: several cells per invocation, rows as bricks, neighbour lists.
    Cpu,
    /// GPUs: one cell per invocation, or two in 16 bits, and sums by workgroups.
    Gpu,
}

impl Kernels {
    /// The kind of processor on an adapter.
    pub fn processor(self, adapter: &wgpu::AdapterInfo) -> Processor {
        match self {
            Self::Auto => Processor::of(adapter),
            Self::Cpu => Processor::Cpu,
            Self::Gpu => Processor::Gpu,
        }
    }
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
            (Some(duration), None) if duration > LONGEST => refuse(
                "run.duration",
                format!("{duration:e} s is longer than {LONGEST:e} s; give the time in seconds"),
            ),
            (Some(duration), None) => positive("run.duration", duration, "s"),
            (None, Some(0)) => refuse("run.steps", "the run has no steps; give at least 1"),
            (None, Some(_)) => Ok(()),
        }?;
        interval("run.checkpoint_every", self.run.checkpoint_every)
    }
}
