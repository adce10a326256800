//! Fields for ParaView: `fields_000123.vti` and the collection `fields.pvd`.

use super::super::{
    recorder::{Notes, Recorder},
    schedule::Schedule,
};
use super::Flow;
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
    pub fn new(engine: &Flow, folder: &Path, last: u64) -> Result<Self> {
        let simulation = &engine.simulation;
        let output = &simulation.scene().output;
        let path = folder.join("fields.pvd");
        let mut fields = output.fields.clone();
        let covered = !simulation.solid().is_empty() || simulation.scene().has_blocks();
        if covered && !fields.contains(&Field::Solid) {
            // Without it, ParaView and pictures show solids as fluid at rest.
            fields.push(Field::Solid);
        }
        Ok(Self {
            schedule: Schedule::new(output.every, simulation.units(), last),
            fields,
            folder: folder.to_owned(),
            collection: match simulation.step() {
                0 => Pvd::create(path)?,
                _ => Pvd::resume(path, simulation.time())?,
            },
        })
    }
}

impl Recorder<Flow> for Fields {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, engine: &mut Flow, notes: &mut Notes) -> Result<()> {
        let step = engine.simulation.step();
        let path = self.folder.join(format!("fields_{step:06}.vti"));
        write_vti(&path, &engine.image(&self.fields)?)?;
        self.collection.add(engine.simulation.time(), &path)?;
        notes.file(self.folder.join("fields.pvd"));
        notes.file(path);
        Ok(())
    }
}
