//! Particles for ParaView: `water_000123.vtp` and the collection `water.pvd`.

use super::super::{
    engine::Engine,
    recorder::{Notes, Recorder},
    schedule::Schedule,
};
use super::SphRun;
use anyhow::Result;
use riprap::{
    output::{Pvd, write_vtp},
    simulation::point_cloud,
};
use std::path::{Path, PathBuf};

pub struct Clouds {
    schedule: Schedule,
    folder: PathBuf,
    collection: Pvd,
}

impl Clouds {
    /// Begins the collection, or resumes it after a restart.
    pub fn new(engine: &SphRun, folder: &Path, last: u64) -> Result<Self> {
        let path = folder.join("water.pvd");
        let every = engine.scene().output.every;
        Ok(Self {
            schedule: Schedule::of(every, engine.time_step(), last),
            folder: folder.to_owned(),
            collection: match engine.step() {
                0 => Pvd::create(path)?,
                _ => Pvd::resume(path, engine.time())?,
            },
        })
    }
}

impl Recorder<SphRun> for Clouds {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, engine: &mut SphRun, notes: &mut Notes) -> Result<()> {
        let water = engine.water()?;
        let path = self.folder.join(format!("water_{:06}.vtp", engine.step()));
        write_vtp(&path, &point_cloud(&water, &engine.scene().output.fields))?;
        self.collection.add(engine.time(), &path)?;
        notes.file(self.folder.join("water.pvd"));
        notes.file(path);
        Ok(())
    }
}
