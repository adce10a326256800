//! The outputs of a run, one type for each, and their schedules.

use super::{rock::Safety, scene_run::SceneRun, statistics::TableStatistics};
use anyhow::Result;
use std::path::PathBuf;

/// The recorders of a run.
pub type Recorders = Vec<Box<dyn Recorder>>;

/// Writes something about the present state when it is due.
pub trait Recorder {
    /// The steps at which it is due.
    fn schedule(&self) -> &Schedule;

    /// Writes its output and logs the files.
    fn record(&mut self, run: &mut SceneRun, log: &mut RunLog) -> Result<()>;

    /// Waits for output that is still being written, and logs the files.
    fn settle(&mut self, _log: &mut RunLog) {}

    /// Statistics of its table, if it has some.
    fn statistics(&self) -> Option<&TableStatistics> {
        None
    }

    /// Writes output that is only available at the end of the run.
    fn finish(&mut self, _run: &SceneRun, _log: &mut RunLog) -> Result<()> {
        Ok(())
    }
}

/// A schedule, and the function that is called when it is due.
impl<F: FnMut(&mut SceneRun, &mut RunLog) -> Result<()>> Recorder for (Schedule, F) {
    fn schedule(&self) -> &Schedule {
        &self.0
    }

    fn record(&mut self, run: &mut SceneRun, log: &mut RunLog) -> Result<()> {
        (self.1)(run, log)
    }
}

/// Files, warnings and extremes of a run, which recorders note.
#[derive(Clone, Debug, Default)]
pub struct RunLog {
    /// Files written, each once.
    pub files: Vec<PathBuf>,
    /// Failures that do not end the run.
    pub warnings: Vec<String>,
    /// The last checkpoint with its step.
    pub checkpoint: Option<(u64, PathBuf)>,
    /// Largest observed speed of the fluid, m/s.
    pub max_speed: f64,
    /// Largest speed of a block's centroid until the last checkpoint, m/s.
    pub block_speed: f64,
    /// Factors of safety of the blocks whose probes request them.
    pub safety: Vec<Safety>,
}

impl RunLog {
    /// Logs a file that was written.
    pub fn file(&mut self, path: PathBuf) {
        if !self.files.contains(&path) {
            self.files.push(path);
        }
    }

    /// Logs a picture, or the failure to draw it, which does not end the run.
    pub fn picture(&mut self, path: PathBuf, drawn: Result<()>) {
        match drawn {
            Ok(()) => self.file(path),
            Err(error) => {
                let warning = format!("{} is not drawn: {error:#}", path.display());
                if !self.warnings.contains(&warning) {
                    self.warnings.push(warning);
                }
            }
        }
    }
}

/// The steps nearest to the multiples of an interval, from 0 on, and the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schedule {
    /// Interval in steps, at least 1 and seldom whole: rounding the multiples keeps them from
    /// drifting.
    every: Option<f64>,
    last: u64,
}

impl Schedule {
    /// A schedule of each `every` seconds, if given, in steps of `time_step` s, and of the step `last`.
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
        // Rounding down may make the next multiple equal to `step`.
        let candidates = [1.0, 2.0].map(|more| ((passed + more) * every).round() as u64);
        let found = candidates.into_iter().find(|next| *next > step);
        found.map_or(self.last, |next| next.min(self.last))
    }
}
