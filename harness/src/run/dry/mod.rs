//! Blocks alone.

mod announce;
mod block_files;
mod block_probe;

use super::{
    engine::{Engine, Recorders},
    recorder::Notes,
    summary::{Rocks, Summary},
    views::{Shown, Views},
};
use crate::search::Finder;
use block_files::BlockFiles;
use block_probe::BlockProbe;
use riprap::{
    Result,
    bodies::{Block, Ledger, Pose},
    checkpoint::BlockCheckpoint,
    output::Array,
    scene::{Field, Quantity, Scene},
    simulation,
};
use std::{path::Path, time::Duration};

/// A scene of blocks alone.
pub struct Dry {
    pub simulation: simulation::Dry<Finder>,
    /// Name of the adapter to draw pictures on, or the first one.
    adapter: Option<String>,
    /// Energies at the start, those that a restart has not seen included.
    start: Ledger,
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

    /// Blocks that move or might.
    pub fn awake(&self) -> usize {
        let blocks = self.simulation.blocks();
        let all = blocks.asleep().enumerate();
        all.filter(|(block, asleep)| !asleep && blocks.moves(*block))
            .count()
    }

    /// What the balance of energies has lost or gained since the start, as a part of what has been
    /// turned over: of the kinetic energy now, the fall of the potential one, and all that was taken.
    pub fn energy_error(&self, now: &Ledger) -> f64 {
        let change = now.balance() - self.start.balance();
        let turned = now.kinetic
            + self.start.kinetic
            + (now.potential - self.start.potential).abs()
            + now.elastic.abs()
            + now.friction
            + now.dashpot
            + now.mass_damping
            + now.driven.abs()
            + now.loads.abs();
        if turned > 0.0 { change / turned } else { 0.0 }
    }

    fn value(&self, quantity: Quantity, ledger: &Ledger) -> f64 {
        let blocks = self.simulation.blocks();
        match quantity {
            Quantity::BlockKineticEnergy => ledger.kinetic,
            Quantity::BlockPotentialEnergy => ledger.potential - self.start.potential,
            Quantity::ContactEnergy => ledger.elastic,
            Quantity::FrictionWork => ledger.friction,
            Quantity::DampingWork => ledger.dashpot + ledger.mass_damping + ledger.lost,
            Quantity::OutsideWork => ledger.driven + ledger.loads,
            Quantity::EnergyError => self.energy_error(ledger),
            Quantity::Contacts => blocks.contacts().count() as f64,
            Quantity::AwakeBlocks => self.awake() as f64,
            Quantity::BlockMaxSpeed => self.max_speed(),
            // A scene without fluid cannot ask for the fluid's.
            _ => f64::NAN,
        }
    }

    /// Largest speed of a centroid, m/s.
    pub fn max_speed(&self) -> f64 {
        let poses = self.simulation.blocks().poses();
        poses
            .iter()
            .map(|pose| pose.velocity.length())
            .fold(0.0, f64::max)
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
        notes.max_speed = notes.max_speed.max(self.max_speed());
        let ledger = self.simulation.blocks().ledger();
        let values = quantities.iter().map(|q| self.value(*q, &ledger));
        Ok(values.collect())
    }

    fn recorders(&mut self, folder: &Path, last: u64) -> anyhow::Result<Recorders<Self>> {
        let scene = self.scene().clone();
        let mut recorders: Recorders<Self> = Vec::new();
        for probe in &scene.probes {
            recorders.push(Box::new(BlockProbe::new(self, folder, last, probe)?));
        }
        recorders.push(Box::new(BlockFiles::new(self, folder, last)?));
        for view in &scene.views {
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
            rocks: Some(Rocks::of(self)),
            ..Summary::default()
        })
    }

    fn announce(&self, _: &Summary, folder: &Path, last: u64) {
        announce::announce(self, folder, last);
    }

    fn pace(&self, _: &Summary, steps: u64, time: Duration) -> String {
        let rate = steps as f64 / time.as_secs_f64().max(1e-9);
        let blocks = self.simulation.blocks();
        format!(
            "{rate:.0} steps/s, {} of {} blocks awake, {} contacts",
            self.awake(),
            blocks.len(),
            blocks.contacts().count()
        )
    }

    fn conclude(&mut self, summary: &mut Summary, notes: &Notes, steps: u64, time: Duration) {
        let mut rocks = Rocks::of(self);
        rocks.max_speed_seen = notes.max_speed.max(rocks.max_speed);
        rocks.steps_a_second = steps as f64 / time.as_secs_f64().max(1e-9);
        summary.rocks = Some(rocks);
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
