//! The state from which a run can go on: `checkpoint.riprap`.

use super::{
    engine::Engine,
    recorder::{Notes, Recorder},
    schedule::Schedule,
};
use anyhow::Result;
use std::path::{Path, PathBuf};

pub struct Checkpoints {
    schedule: Schedule,
    path: PathBuf,
}

impl Checkpoints {
    pub fn new(engine: &Engine, folder: &Path, last: u64) -> Self {
        let simulation = &engine.simulation;
        let every = simulation.scene().run.checkpoint_every;
        Self {
            schedule: Schedule::new(every, simulation.units(), last),
            path: folder.join("checkpoint.riprap"),
        }
    }
}

impl Recorder for Checkpoints {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, engine: &mut Engine, notes: &mut Notes) -> Result<()> {
        let step = engine.simulation.step();
        if step == 0 {
            return Ok(());
        }
        engine.checkpoint()?.write(&self.path)?;
        notes.checkpoint = Some((step, self.path.clone()));
        notes.file(self.path.clone());
        Ok(())
    }
}
