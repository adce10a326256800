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
    pub fn new(engine: &impl Engine, folder: &Path, last: u64) -> Self {
        let every = engine.scene().run.checkpoint_every;
        Self {
            schedule: Schedule::of(every, engine.time_step(), last),
            path: folder.join("checkpoint.riprap"),
        }
    }
}

impl<E: Engine> Recorder<E> for Checkpoints {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, engine: &mut E, notes: &mut Notes) -> Result<()> {
        let step = engine.step();
        if step == 0 {
            return Ok(());
        }
        engine.checkpoint(&self.path)?;
        notes.checkpoint = Some((step, self.path.clone()));
        notes.file(self.path.clone());
        Ok(())
    }
}
