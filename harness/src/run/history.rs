//! Sums over the fluid and the blocks in time: `history.csv` and `history.png`.

use super::{
    curves,
    recorder::{Recorder, RunLog},
    scene_run::SceneRun,
    schedule::Schedule,
};
use crate::picture::Track;
use anyhow::Result;
use riprap::{
    output::Csv,
    scene::{self, Quantity},
};
use std::path::{Path, PathBuf};

/// Points of a curve where the scene does not say how many: enough for a picture.
const POINTS: f64 = 200.0;

pub struct History {
    schedule: Schedule,
    quantities: Vec<Quantity>,
    path: PathBuf,
    table: Csv,
}

impl History {
    /// Begins the table of the history of this number, or goes on with it after a restart.
    pub fn new(run: &SceneRun, folder: &Path, last: u64, number: usize) -> Result<Self> {
        let scene = run.scene();
        let history = &scene.output.histories[number];
        let path = folder.join(format!("{}.csv", name(number)));
        let columns: Vec<&str> = history.quantities.iter().map(|q| q.name()).collect();
        // Of the scene's run, not of `--steps`: a run in parts has one table.
        let usual = scene.run.length(run.time_step()) / POINTS;
        let every = history.every.or(Some(usual));
        Ok(Self {
            schedule: Schedule::new(every, run.time_step(), last),
            quantities: history.quantities.clone(),
            table: table(run, &path, &columns)?,
            path,
        })
    }
}

/// Name of the files of a history: `history`, `history_2`, ….
pub fn name(number: usize) -> String {
    match number {
        0 => "history".into(),
        _ => format!("history_{}", number + 1),
    }
}

/// The table at `path`: a new one at the start of a run, else the one that a restart continues.
pub fn table<S: AsRef<str>>(run: &SceneRun, path: &Path, columns: &[S]) -> riprap::Result<Csv> {
    match run.step() {
        0 => Csv::create(path, columns),
        step => Csv::resume(path, columns, step),
    }
}

/// Whether a probe of this name would overwrite a history.
pub fn claims(histories: &[scene::History], probe: &str) -> bool {
    (0..histories.len()).any(|number| name(number) == probe)
}

/// Name and unit of a quantity.
pub fn about(quantity: Quantity) -> (&'static str, &'static str) {
    match quantity {
        Quantity::KineticEnergy => ("kinetic energy", "J"),
        Quantity::Enstrophy => ("enstrophy", "m³/s²"),
        Quantity::Mass => ("mass", "kg"),
        Quantity::MomentumX => ("momentum along x", "kg m/s"),
        Quantity::MomentumY => ("momentum along y", "kg m/s"),
        Quantity::MomentumZ => ("momentum along z", "kg m/s"),
        Quantity::MaxSpeed => ("largest speed", "m/s"),
        Quantity::PotentialEnergy => ("potential energy", "J"),
        Quantity::CompressionEnergy => ("energy of compression", "J"),
        Quantity::EscapedEnergy => ("energy of what has left", "J"),
        Quantity::BodyWork => ("work of blocks on water", "J"),
        Quantity::PushWork => ("work of walls that push", "J"),
        Quantity::DummyWork => ("work of dummy particles", "J"),
        Quantity::DissipatedEnergy => ("energy that water dissipated", "J"),
        Quantity::JointWork => ("work of blocks in joints", "J"),
        Quantity::LostToWater => ("energy of blocks lost to water", "J"),
        Quantity::BlockKineticEnergy => ("kinetic energy of blocks", "J"),
        Quantity::BlockPotentialEnergy => ("potential energy of blocks", "J"),
        Quantity::StrainEnergy => ("strain energy of blocks", "J"),
        Quantity::ContactEnergy => ("elastic energy of contacts", "J"),
        Quantity::FrictionWork => ("work of friction", "J"),
        Quantity::DampingWork => ("work of damping", "J"),
        Quantity::ContactLoss => ("loss in contacts that ended", "J"),
        Quantity::OutsideWork => ("work of drives and loads", "J"),
        Quantity::EnergyError => ("error of the energy", ""),
        Quantity::Contacts => ("contacts", ""),
        Quantity::AwakeBlocks => ("awake blocks", ""),
        Quantity::BlockMaxSpeed => ("largest speed of a block", "m/s"),
        Quantity::MaxVonMises => ("largest von Mises stress", "Pa"),
    }
}

impl Recorder for History {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, run: &mut SceneRun, log: &mut RunLog) -> Result<()> {
        let values = run.values(&self.quantities, log)?;
        let (step, time) = (run.step(), run.time());
        self.table.append(step, time, &values)?;
        log.file(self.path.clone());
        Ok(())
    }

    fn finish(&mut self, run: &SceneRun, log: &mut RunLog) -> Result<()> {
        let names: Vec<[&str; 1]> = self.quantities.iter().map(|q| [q.name()]).collect();
        let tracks: Vec<Track<'_>> = self
            .quantities
            .iter()
            .zip(&names)
            .map(|(quantity, columns)| {
                let (quantity, unit) = about(*quantity);
                Track {
                    quantity,
                    unit,
                    columns,
                }
            })
            .collect();
        let scene = run.scene();
        curves::draw(scene, &self.path, &scene.title, &tracks, log)
    }
}
