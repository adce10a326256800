//! A table for each probe: `NAME.csv`.

use super::super::{
    history::table,
    recorder::{Recorder, RunLog},
    scene_run::SceneRun,
    schedule::Schedule,
};
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
    pub fn new(run: &SceneRun, folder: &Path, last: u64, probe: &Probe) -> Result<Self> {
        let simulation = &run.simulation;
        let gauge = Gauge::new(simulation.scene(), simulation.solid(), probe)?;
        let path = folder.join(format!("{}.csv", probe.name));
        Ok(Self {
            schedule: Schedule::new(probe.every, simulation.time_step(), last),
            table: table(run, &path, gauge.columns())?,
            path,
            gauge,
        })
    }
}

impl Recorder for ProbeTable {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, run: &mut SceneRun, log: &mut RunLog) -> Result<()> {
        let arrays = run.read(self.gauge.fields(), self.gauge.cells())?;
        let (step, time) = (run.simulation.step(), run.simulation.time());
        for row in self.gauge.rows(&arrays)? {
            self.table.append(step, time, &row)?;
        }
        log.file(self.path.clone());
        Ok(())
    }
}
