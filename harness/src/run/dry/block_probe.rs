//! A table for each block that a probe follows: `NAME.csv`.

use super::super::{
    engine::Engine,
    history::table,
    recorder::{Notes, Recorder},
    schedule::Schedule,
};
use super::Dry;
use anyhow::Result;
use riprap::{
    Error,
    output::Csv,
    scene::{Probe, ProbePlace},
};
use std::path::{Path, PathBuf};

/// What is measured, each along x, y and z.
const MEASURED: [&str; 6] = [
    "position", "velocity", "rotation", "spin", "force", "torque",
];

pub struct BlockProbe {
    schedule: Schedule,
    block: usize,
    path: PathBuf,
    table: Csv,
}

impl BlockProbe {
    /// Begins the table, or goes on with it after a restart.
    pub fn new(engine: &Dry, folder: &Path, last: u64, probe: &Probe) -> Result<Self> {
        let ProbePlace::Block { block: name } = &probe.place else {
            let message = "measures a fluid, and there is none";
            return Err(Error::scene(format!("probes.{}", probe.name), message).into());
        };
        let mut blocks = engine.simulation.setup().blocks.iter();
        let block = blocks.position(|block| block.name == *name);
        let block = block.ok_or_else(|| {
            Error::scene(
                format!("probes.{}", probe.name),
                format!("there is no block `{name}`"),
            )
        })?;
        let along = |what: &&str| ["x", "y", "z"].map(|axis| format!("{what}_{axis}"));
        let columns: Vec<String> = MEASURED.iter().flat_map(along).collect();
        let path = folder.join(format!("{}.csv", probe.name));
        Ok(Self {
            schedule: Schedule::of(probe.every, engine.time_step(), last),
            table: table(engine, &path, &columns)?,
            block,
            path,
        })
    }
}

impl Recorder<Dry> for BlockProbe {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, engine: &mut Dry, notes: &mut Notes) -> Result<()> {
        let (simulation, block) = (&engine.simulation, self.block);
        let blocks = simulation.blocks();
        let pose = blocks.poses()[block];
        let at_start = simulation.setup().blocks[block].rotation;
        let turned = (blocks.rotation(block) * at_start.conjugate()).to_scaled_axis();
        let values: Vec<f64> = [
            Some(pose.centre),
            Some(pose.velocity),
            Some(turned.map(f64::to_degrees)),
            blocks.spins().nth(block),
            blocks.contact_forces().nth(block),
            blocks.contact_torques().nth(block),
        ]
        .into_iter()
        .flatten()
        .flat_map(|vector| vector.to_array())
        .collect();
        self.table.append(engine.step(), engine.time(), &values)?;
        notes.file(self.path.clone());
        Ok(())
    }
}
