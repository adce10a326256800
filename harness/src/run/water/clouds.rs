//! Particles for ParaView: `water_000123.vtp` and the collection `water.pvd`.

use super::super::{
    recorder::{Recorder, RunLog},
    scene_run::SceneRun,
    schedule::Schedule,
};
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
    pub fn new(run: &SceneRun, folder: &Path, last: u64) -> Result<Self> {
        let path = folder.join("water.pvd");
        let every = run.scene().output.every;
        Ok(Self {
            schedule: Schedule::new(every, run.time_step(), last),
            folder: folder.to_owned(),
            collection: match run.step() {
                0 => Pvd::create(path)?,
                _ => Pvd::resume(path, run.time())?,
            },
        })
    }
}

impl Recorder for Clouds {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, run: &mut SceneRun, log: &mut RunLog) -> Result<()> {
        let water = run.water()?;
        let path = self.folder.join(format!("water_{:06}.vtp", run.step()));
        write_vtp(&path, &point_cloud(&water, &run.scene().output.fields))?;
        self.collection.add(run.time(), &path)?;
        log.file(self.folder.join("water.pvd"));
        log.file(path);
        Ok(())
    }
}
