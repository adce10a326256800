//! A table for each probe: `NAME.csv`.

use super::super::{
    history::table,
    recorder::{Notes, Recorder},
    schedule::Schedule,
    views::Shown,
};
use super::Flow;
use anyhow::Result;
use riprap::{output::Csv, scene::Probe, simulation::probe::Gauge};
use std::path::{Path, PathBuf};

pub struct ProbeTable {
    schedule: Schedule,
    gauge: Gauge,
    path: PathBuf,
    table: Csv,
}

impl ProbeTable {
    /// Begins the table, or goes on with it after a restart.
    pub fn new(engine: &Flow, folder: &Path, last: u64, probe: &Probe) -> Result<Self> {
        let simulation = &engine.simulation;
        let gauge = Gauge::new(simulation.scene(), simulation.solid(), probe)?;
        let path = folder.join(format!("{}.csv", probe.name));
        Ok(Self {
            schedule: Schedule::new(probe.every, simulation.units(), last),
            table: table(engine, &path, gauge.columns())?,
            path,
            gauge,
        })
    }
}

impl Recorder<Flow> for ProbeTable {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, engine: &mut Flow, notes: &mut Notes) -> Result<()> {
        let arrays = engine.read(self.gauge.fields(), self.gauge.cells())?;
        let (step, time) = (engine.simulation.step(), engine.simulation.time());
        for row in self.gauge.rows(&arrays)? {
            self.table.append(step, time, &row)?;
        }
        notes.file(self.path.clone());
        Ok(())
    }
}
