//! Fields for ParaView: `fields_000123.vti` and the collection `fields.pvd`.

use super::super::{
    recorder::{Recorder, RunLog},
    scene_run::SceneRun,
    schedule::Schedule,
};
use anyhow::Result;
use riprap::{
    output::{Pvd, write_vti},
    scene::Field,
};
use std::path::{Path, PathBuf};

pub struct Fields {
    schedule: Schedule,
    fields: Vec<Field>,
    folder: PathBuf,
    collection: Pvd,
}

impl Fields {
    /// Begins the collection, or goes on with it after a restart.
    pub fn new(run: &SceneRun, folder: &Path, last: u64) -> Result<Self> {
        let simulation = &run.simulation;
        let output = &simulation.scene().output;
        let path = folder.join("fields.pvd");
        let mut fields = output.fields.clone();
        let covered = !simulation.solid().is_empty() || simulation.scene().has_blocks();
        if covered && !fields.contains(&Field::Solid) {
            // Without it, ParaView and pictures show solids as fluid at rest.
            fields.push(Field::Solid);
        }
        Ok(Self {
            schedule: Schedule::new(output.every, simulation.time_step(), last),
            fields,
            folder: folder.to_owned(),
            collection: match simulation.step() {
                0 => Pvd::create(path)?,
                _ => Pvd::resume(path, simulation.time())?,
            },
        })
    }
}

impl Recorder for Fields {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, run: &mut SceneRun, log: &mut RunLog) -> Result<()> {
        let step = run.simulation.step();
        let path = self.folder.join(format!("fields_{step:06}.vti"));
        write_vti(&path, &run.image(&self.fields)?)?;
        self.collection.add(run.simulation.time(), &path)?;
        log.file(self.folder.join("fields.pvd"));
        log.file(path);
        Ok(())
    }
}
