//! The largest speed, for the Mach number in the summary.

use super::super::{
    recorder::{Recorder, RunLog},
    scene_run::SceneRun,
    schedule::Schedule,
};
use anyhow::Result;

/// Looks in a run, beside those of the histories: seldom enough to cost nothing.
const LOOKS: f64 = 20.0;

pub struct MaxSpeed(Schedule);

impl MaxSpeed {
    pub fn new(run: &SceneRun, last: u64) -> Self {
        let every = run.time_step() * last as f64 / LOOKS;
        Self(Schedule::new(Some(every), run.time_step(), last))
    }
}

impl Recorder for MaxSpeed {
    fn schedule(&self) -> &Schedule {
        &self.0
    }

    fn record(&mut self, run: &mut SceneRun, log: &mut RunLog) -> Result<()> {
        log.max_speed = log.max_speed.max(run.totals()?.max_speed);
        Ok(())
    }
}
