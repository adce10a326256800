//! The largest speed, for the Mach number in the summary.

use super::super::{
    recorder::{Notes, Recorder},
    schedule::Schedule,
};
use super::Flow;
use anyhow::Result;

/// Looks in a run, beside those of the histories: seldom enough to cost nothing.
const LOOKS: f64 = 20.0;

pub struct Watch(Schedule);

impl Watch {
    pub fn new(engine: &Flow, last: u64) -> Self {
        let units = engine.simulation.units();
        let every = units.time_from_lattice(last as f64) / LOOKS;
        Self(Schedule::new(Some(every), units, last))
    }
}

impl Recorder<Flow> for Watch {
    fn schedule(&self) -> &Schedule {
        &self.0
    }

    fn record(&mut self, engine: &mut Flow, notes: &mut Notes) -> Result<()> {
        notes.max_speed = notes.max_speed.max(engine.totals()?.max_speed);
        Ok(())
    }
}
