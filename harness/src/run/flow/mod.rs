//! A fluid on a device of its own, with the blocks in it, every wait with an end.

mod announce;
mod coupling;
mod fields;
mod probes;
mod shown;
mod solids;
mod walls;
mod watch;

use super::{
    engine::{Engine, Recorders},
    left_out::LeftOut,
    pace::Pace,
    recorder::Notes,
    rock::{self, BlockFiles, Rock, Rocks},
    slices::Pictures,
    summary::Summary,
    views::Views,
};
use crate::{bench::copy_bandwidth, gpu};
pub use coupling::Coupling;
use fields::Fields;
use probes::ProbeTable;
use riprap::{
    Result,
    coupling::Coupled,
    lattice::{bytes_a_cell, bytes_a_step},
    output::Image,
    rock::{Block, EnergyLedger},
    scene::{Field, ProbePlace, Quantity, Scene},
    simulation::{Needs, Simulation, Totals, checkpoint::Checkpoint},
    wgpu,
};
use solids::solid_blocks;
use std::{path::Path, time::Duration};
use watch::Watch;

/// Bytes whose copying shows what memory allows: more than caches hold.
const BYTES: u64 = 128 << 20;

/// A step of 10⁸ cells takes a CPU adapter most of a minute, and compiling kernels as long; ten times
/// that is no longer slow but stuck.
const PATIENCE: Duration = Duration::from_secs(600);

/// A flow on a device.
pub struct Flow {
    pub adapter: wgpu::AdapterInfo,
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub needs: Needs,
    pub simulation: Simulation,
    /// Energies of the blocks at the start, those that a restart has not seen included.
    start: EnergyLedger,
    /// Static solids, where there are views of them.
    solids: Vec<Block>,
}

impl Flow {
    /// The scene that was read from `file` at its start, on the adapter called `adapter` or on the best
    /// one.
    pub fn open(scene: &Scene, file: &Path, adapter: Option<&str>) -> Result<Self> {
        Self::of(scene, adapter).map_err(|error| crate::search::located(error, file))
    }

    fn of(scene: &Scene, adapter: Option<&str>) -> Result<Self> {
        let adapter = gpu::pick(adapter)?;
        let needs = Needs::of(scene, &adapter)?;
        let (device, queue) = gpu::open(&adapter, needs.features, needs.limits.clone())?;
        let made = Simulation::new(&device, &queue, scene);
        let simulation = gpu::drive(&device, PATIENCE, "the kernels", made)??;
        Ok(Self {
            adapter: adapter.get_info(),
            start: simulation
                .coupled()
                .map_or_else(EnergyLedger::default, |coupled| coupled.blocks().ledger()),
            device,
            queue,
            needs,
            simulation,
            solids: match scene.views.is_empty() {
                true => Vec::new(),
                false => solid_blocks(scene),
            },
        })
    }

    pub fn image(&mut self, fields: &[Field]) -> Result<Image> {
        let image = self.simulation.image(fields);
        gpu::drive(&self.device, PATIENCE, "reading the fields", image)?
    }

    pub fn totals(&mut self) -> Result<Totals> {
        let totals = self.simulation.totals();
        gpu::drive(&self.device, PATIENCE, "summing up", totals)?
    }

    /// Blocks that are shown, the first ones: the faces of the domain that hold them are none.
    fn shown(&self) -> usize {
        let in_fluid = self.simulation.coupled().map(Coupled::in_fluid);
        in_fluid.unwrap_or_default() + self.simulation.scene().solids.len()
    }

    /// Bytes a second that the device copies.
    fn bandwidth(&self) -> Result<f64> {
        copy_bandwidth(&self.device, &self.queue, BYTES)
    }
}

impl Engine for Flow {
    fn scene(&self) -> &Scene {
        self.simulation.scene()
    }

    fn step(&self) -> u64 {
        self.simulation.step()
    }

    fn time_step(&self) -> f64 {
        self.simulation.units().time_step
    }

    fn time(&self) -> f64 {
        self.simulation.time()
    }

    fn rock(&self) -> Option<Rock<'_>> {
        let simulation = &self.simulation;
        let coupled = simulation.coupled()?;
        let in_fluid = coupled.in_fluid();
        Some(Rock {
            step: simulation.step(),
            time: simulation.time(),
            setup: &coupled.setup().setup,
            blocks: coupled.blocks(),
            felt: &coupled.external_load()[..in_fluid],
            coupled: Some(coupled),
            shown: self.shown(),
            start: &self.start,
        })
    }

    fn is_good(&self) -> bool {
        false
    }

    fn advance(&mut self, steps: u64) -> Result<()> {
        let what = format!("{steps} steps");
        let done = self.simulation.advance(steps);
        gpu::drive(&self.device, PATIENCE, &what, done)?
    }

    fn restore(&mut self, path: &Path) -> Result<()> {
        self.simulation.restore(&Checkpoint::read(path)?)
    }

    fn checkpoint(&mut self, path: &Path) -> Result<()> {
        let checkpoint = self.simulation.checkpoint();
        gpu::drive(&self.device, PATIENCE, "reading the state", checkpoint)??.write(path)
    }

    fn values(&mut self, quantities: &[Quantity], notes: &mut Notes) -> Result<Vec<f64>> {
        let totals = match quantities.iter().all(|quantity| quantity.is_of_blocks()) {
            true => Totals::default(),
            false => self.totals()?,
        };
        notes.max_speed = notes.max_speed.max(totals.max_speed);
        let of_fluid = |quantity| value(quantity, &totals);
        Ok(rock::values(self.rock(), quantities, notes, of_fluid))
    }

    fn recorders(&mut self, folder: &Path, last: u64) -> anyhow::Result<Recorders<Self>> {
        let scene = self.scene().clone();
        let mut recorders: Recorders<Self> = vec![Box::new(Watch::new(self, last))];
        for probe in &scene.probes {
            if let ProbePlace::Block {
                block,
                faces,
                safety,
            } = &probe.place
            {
                let asked = [*faces, *safety];
                recorders.extend(rock::probes(self, folder, last, (probe, block), asked)?);
            } else {
                recorders.push(Box::new(ProbeTable::new(self, folder, last, probe)?));
            }
        }
        recorders.push(Box::new(Fields::new(self, folder, last)?));
        for slice in &scene.output.slices {
            recorders.push(Box::new(Pictures::new(self, folder, last, slice)));
        }
        if scene.has_blocks() {
            recorders.push(Box::new(BlockFiles::new(self, folder, last)?));
        }
        for view in &scene.views {
            let adapter = Some(self.adapter.name.clone());
            recorders.push(Box::new(Views::new(self, folder, last, view, adapter)));
        }
        Ok(recorders)
    }

    fn summary(&self) -> anyhow::Result<Summary> {
        let simulation = &self.simulation;
        let (scene, units) = (simulation.scene(), simulation.units());
        let lattice = simulation.lattice();
        let setup = lattice.setup();
        Ok(Summary {
            title: scene.title.clone(),
            adapter: gpu::describe(&self.adapter),
            cells: scene.cells(),
            fluid_cells: lattice.geometry().fluid_cells,
            cell: units.cell,
            time_step: units.time_step,
            tau: setup.tau(),
            kernel: format!(
                "{:?} {:?} {:?} lanes {}{}",
                setup.collision,
                setup.equilibrium,
                setup.storage,
                setup.lanes,
                if setup.wale.is_some() { " Wale" } else { "" }
            ),
            first_step: simulation.step(),
            bandwidth: self.bandwidth()?,
            bytes_a_cell: bytes_a_cell(setup),
            bytes_a_step: bytes_a_step(setup, lattice.grid(), lattice.geometry()),
            warnings: simulation
                .advice()
                .iter()
                .map(ToString::to_string)
                .collect(),
            rocks: Rocks::of(self),
            coupling: Coupling::of(simulation, 0),
            left_out: LeftOut::of_lattice(lattice),
            ..Summary::default()
        })
    }

    fn announce(&self, summary: &Summary, folder: &Path, last: u64) {
        announce::announce(self, folder, last, summary.bandwidth);
    }

    fn describe_pace(&self, summary: &Summary, pace: &Pace) -> String {
        let (mlups, share) = speed(summary, pace);
        let fluid = format!("{mlups:.1} MLUPS, {:.0} % of memory speed", 100.0 * share);
        match self.rock() {
            Some(rock) => format!("{fluid}; {}", rock.activity()),
            None => fluid,
        }
    }

    fn conclude(&mut self, summary: &mut Summary, notes: &Notes, pace: &Pace) {
        // Others may have kept the device busy the first time.
        if let Ok(again) = self.bandwidth() {
            summary.bandwidth = summary.bandwidth.max(again);
        }
        (summary.mlups, summary.bandwidth_share) = speed(summary, pace);
        summary.max_mach = self.simulation.units().mach(notes.max_speed);
        summary.rocks = Rocks::concluded(self, notes, pace);
        summary.coupling = Coupling::of(&self.simulation, pace.whole().steps);
        self.look_at_walls(summary);
    }
}

/// Million cell updates a second, and the part of what memory allows, once kernels are compiled.
fn speed(summary: &Summary, pace: &Pace) -> (f64, f64) {
    let warm = pace.warm();
    let rate = warm.rate(warm.steps);
    (
        rate * summary.fluid_cells as f64 / 1e6,
        rate * summary.bytes_a_step as f64 / summary.bandwidth,
    )
}

fn value(quantity: Quantity, totals: &Totals) -> f64 {
    match quantity {
        Quantity::KineticEnergy => totals.kinetic_energy,
        Quantity::Enstrophy => totals.enstrophy,
        Quantity::Mass => totals.mass,
        Quantity::MomentumX => totals.momentum[0],
        Quantity::MomentumY => totals.momentum[1],
        Quantity::MomentumZ => totals.momentum[2],
        Quantity::MaxSpeed => totals.max_speed,
        // A scene without blocks cannot ask for theirs.
        _ => f64::NAN,
    }
}
