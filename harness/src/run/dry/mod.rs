//! Blocks alone.

mod announce;

use super::{
    engine::{Engine, Recorders},
    pace::Pace,
    recorder::Notes,
    rock::{self, BlockFiles, Rock, Rocks},
    summary::Summary,
    views::{Shown, Views},
};
use crate::search::Finder;
use riprap::{
    Error, Result,
    geometry::Pose,
    output::Array,
    rock::{Block, EnergyLedger},
    scene::{Field, ProbePlace, Quantity, Scene},
    simulation::{self, checkpoint::BlockCheckpoint},
};
use std::path::Path;

/// A scene of blocks alone.
pub struct Dry {
    pub simulation: simulation::Dry<Finder>,
    /// Name of the adapter to draw pictures on, or the first one.
    adapter: Option<String>,
    /// Energies at the start, those that a restart has not seen included.
    start: EnergyLedger,
}

impl Dry {
    /// The scene that was read from `file`, at its start; the adapter called `adapter`, or the best one, is only opened by what
    /// needs it.
    pub fn open(scene: &Scene, file: &Path, adapter: Option<&str>) -> Result<Self> {
        let simulation = crate::search::open(scene, file, adapter)?;
        Ok(Self {
            start: simulation.blocks().ledger(),
            simulation,
            adapter: adapter.map(Into::into),
        })
    }

    /// What may disappoint in it.
    fn warnings(&self) -> Vec<String> {
        let slips = self.simulation.scene().slips(self.simulation.time_step());
        slips.iter().map(ToString::to_string).collect()
    }
}

impl Engine for Dry {
    fn scene(&self) -> &Scene {
        self.simulation.scene()
    }

    fn step(&self) -> u64 {
        self.simulation.step()
    }

    fn time_step(&self) -> f64 {
        self.simulation.time_step()
    }

    fn time(&self) -> f64 {
        self.simulation.time()
    }

    fn rock(&self) -> Option<Rock<'_>> {
        let simulation = &self.simulation;
        Some(Rock {
            step: simulation.step(),
            time: simulation.time(),
            setup: simulation.setup(),
            blocks: simulation.blocks(),
            felt: &[],
            coupled: None,
            shown: simulation.blocks().len(),
            start: &self.start,
        })
    }

    /// It goes back to the last good step.
    fn is_good(&self) -> bool {
        true
    }

    fn advance(&mut self, steps: u64) -> Result<()> {
        crate::search::drive(&mut self.simulation, steps)
    }

    fn restore(&mut self, path: &Path) -> Result<()> {
        self.simulation.restore(&BlockCheckpoint::read(path)?)
    }

    fn checkpoint(&mut self, path: &Path) -> Result<()> {
        self.simulation.checkpoint().write(path)
    }

    fn values(&mut self, quantities: &[Quantity], notes: &mut Notes) -> Result<Vec<f64>> {
        Ok(rock::values(self.rock(), quantities, notes, |_| f64::NAN))
    }

    fn recorders(&mut self, folder: &Path, last: u64) -> anyhow::Result<Recorders<Self>> {
        let mut recorders: Recorders<Self> = Vec::new();
        for probe in &self.scene().probes {
            let ProbePlace::Block { block, safety, .. } = &probe.place else {
                let message = "measures a fluid, and there is none";
                return Err(Error::scene(format!("probes.{}", probe.name), message).into());
            };
            let asked = [false, *safety];
            recorders.extend(rock::probes(self, folder, last, (probe, block), asked)?);
        }
        recorders.push(Box::new(BlockFiles::new(self, folder, last)?));
        for view in &self.scene().views {
            let adapter = self.adapter.clone();
            recorders.push(Box::new(Views::new(self, folder, last, view, adapter)));
        }
        Ok(recorders)
    }

    fn summary(&self) -> anyhow::Result<Summary> {
        let simulation = &self.simulation;
        Ok(Summary {
            title: simulation.scene().title.clone(),
            adapter: simulation.finder().describe(),
            time_step: simulation.time_step(),
            first_step: simulation.step(),
            warnings: self.warnings(),
            rocks: Rocks::of(self),
            ..Summary::default()
        })
    }

    fn announce(&self, _: &Summary, folder: &Path, last: u64) {
        announce::announce(self, folder, last);
    }

    fn describe_pace(&self, _: &Summary, pace: &Pace) -> String {
        let warm = pace.warm();
        let rate = warm.rate(warm.steps);
        let activity = self.rock().map(|rock| rock.activity());
        format!("{rate:.0} steps/s, {}", activity.unwrap_or_default())
    }

    fn conclude(&mut self, summary: &mut Summary, notes: &Notes, pace: &Pace) {
        summary.rocks = Rocks::concluded(self, notes, pace);
    }
}

impl Shown for Dry {
    fn blocks(&self) -> &[Block] {
        &self.simulation.setup().blocks
    }

    fn solids(&self) -> usize {
        self.scene().solids.len()
    }

    fn poses(&self) -> Vec<Pose> {
        self.simulation.blocks().poses()
    }

    fn read(&mut self, _: &[Field], _: &[u32]) -> Result<Vec<Array>> {
        Ok(Vec::new())
    }
}
