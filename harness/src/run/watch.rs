//! The largest speed, for the Mach number in the summary.

use super::{
    engine::Engine,
    recorder::{Notes, Recorder},
    schedule::Schedule,
};
use anyhow::Result;

/// Looks in a run, beside those of the histories: seldom enough to cost nothing.
const LOOKS: f64 = 20.0;

pub struct Watch(Schedule);

impl Watch {
    pub fn new(engine: &Engine, last: u64) -> Self {
        let units = engine.simulation.units();
        let every = units.time_from_lattice(last as f64) / LOOKS;
        Self(Schedule::new(Some(every), units, last))
    }
}

impl Recorder for Watch {
    fn schedule(&self) -> &Schedule {
        &self.0
    }

    fn record(&mut self, engine: &mut Engine, notes: &mut Notes) -> Result<()> {
        notes.max_speed = notes.max_speed.max(engine.totals()?.max_speed);
        Ok(())
    }
}
