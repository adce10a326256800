//! A fluid on a device of its own, with the blocks in it, every wait with an end.

mod announce;
mod coupling;
mod fields;
mod probes;
mod slices;
mod watch;

use super::{
    engine::{Engine, Recorders},
    recorder::Notes,
    rock::{self, BlockProbe, Rock, Rocks},
    summary::Summary,
};
use crate::{bench::copy_bandwidth, gpu};
pub use coupling::Coupling;
use fields::Fields;
use probes::ProbeTable;
use riprap::{
    Result,
    bodies::Ledger,
    checkpoint::Checkpoint,
    lattice::{bytes_a_cell, bytes_a_step},
    output::{Array, Image},
    scene::{Field, ProbePlace, Quantity, Scene},
    simulation::{FirstCell, Needs, SUBLAYER, Simulation, Totals},
    wgpu,
};
use slices::Pictures;
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
    start: Ledger,
    /// Name of the adapter that was asked for.
    asked: Option<String>,
}

impl Flow {
    /// The scene that was read from `file` at its start, on the adapter called `adapter` or on the best
    /// one.
    pub fn open(scene: &Scene, file: &Path, adapter: Option<&str>) -> Result<Self> {
        Self::of(scene, adapter).map_err(|error| crate::search::located(error, file))
    }

    fn of(scene: &Scene, asked: Option<&str>) -> Result<Self> {
        let adapter = gpu::pick(asked)?;
        let needs = Needs::of(scene, &adapter)?;
        let (device, queue) = gpu::open(&adapter, needs.features, needs.limits.clone())?;
        let made = Simulation::new(&device, &queue, scene);
        let simulation = gpu::drive(&device, PATIENCE, "the kernels", made)??;
        Ok(Self {
            adapter: adapter.get_info(),
            start: simulation
                .coupled()
                .map_or_else(Ledger::default, |coupled| coupled.blocks().ledger()),
            asked: asked.map(Into::into),
            device,
            queue,
            needs,
            simulation,
        })
    }

    pub fn image(&mut self, fields: &[Field]) -> Result<Image> {
        let image = self.simulation.image(fields);
        gpu::drive(&self.device, PATIENCE, "reading the fields", image)?
    }

    pub fn read(&mut self, fields: &[Field], cells: &[u32]) -> Result<Vec<Array>> {
        let read = self.simulation.read(fields, cells);
        gpu::drive(&self.device, PATIENCE, "reading cells", read)?
    }

    pub fn totals(&mut self) -> Result<Totals> {
        let totals = self.simulation.totals();
        gpu::drive(&self.device, PATIENCE, "summing up", totals)?
    }

    /// Whether the shear at walls and blocks is resolved; of a flow that has diverged nobody knows.
    fn look_at_walls(&mut self, summary: &mut Summary) {
        if summary.diverged {
            return;
        }
        let looked = self.simulation.wall_units();
        let looked = gpu::drive(&self.device, PATIENCE, "reading cells beside walls", looked);
        let found = match looked {
            Ok(Ok(found)) => found,
            Ok(Err(error)) | Err(error) => {
                return summary.warnings.push(format!("y⁺ is not known: {error}"));
            }
        };
        summary.y_plus_walls = found.walls.map(|cell| cell.y_plus);
        summary.y_plus_blocks = found.blocks.map(|cell| cell.y_plus);
        for cell in [found.walls, found.blocks].into_iter().flatten() {
            if cell.y_plus > SUBLAYER {
                let beside = match (cell.block, self.rock()) {
                    (Some(block), Some(rock)) => format!("block {}", rock.blocks.name(block)),
                    _ => "a wall".into(),
                };
                let finer = self.simulation.units().cell * SUBLAYER / cell.y_plus;
                summary.warnings.push(y_plus_warning(&cell, &beside, finer));
            }
        }
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
            scene: simulation.scene(),
            step: simulation.step(),
            time: simulation.time(),
            setup: &coupled.setup().setup,
            blocks: coupled.blocks(),
            felt: &coupled.felt()[..in_fluid],
            shown: in_fluid + simulation.scene().solids.len(),
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
        let rock = self.rock();
        if let Some(rock) = &rock {
            notes.block_speed = notes.block_speed.max(rock.max_speed());
        }
        let ledger = rock.map(|rock| rock.blocks.ledger()).unwrap_or_default();
        let value = |quantity: &Quantity| match &rock {
            Some(rock) if quantity.is_of_blocks() => rock::value(rock, *quantity, &ledger),
            _ => value(*quantity, &totals),
        };
        Ok(quantities.iter().map(value).collect())
    }

    fn recorders(&mut self, folder: &Path, last: u64) -> anyhow::Result<Recorders<Self>> {
        let scene = self.scene().clone();
        let mut recorders: Recorders<Self> = vec![Box::new(Watch::new(self, last))];
        for probe in &scene.probes {
            recorders.push(match &probe.place {
                ProbePlace::Block { block } => {
                    Box::new(BlockProbe::new(self, folder, last, (probe, block))?)
                }
                _ => Box::new(ProbeTable::new(self, folder, last, probe)?),
            });
        }
        recorders.push(Box::new(Fields::new(self, folder, last)?));
        for slice in &scene.output.slices {
            recorders.push(Box::new(Pictures::new(self, folder, last, slice)));
        }
        if scene.has_blocks() {
            let adapter = self.asked.as_deref();
            recorders.extend(rock::recorders(self, adapter, folder, last)?);
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
            rocks: self.rock().map(|rock| Rocks::of(&rock, self.time_step())),
            coupling: Coupling::of(simulation, 0),
            ..Summary::default()
        })
    }

    fn announce(&self, summary: &Summary, folder: &Path, last: u64) {
        announce::announce(self, folder, last, summary.bandwidth);
    }

    fn pace(&self, summary: &Summary, steps: u64, time: Duration) -> String {
        let (mlups, share) = speed(summary, steps, time);
        let fluid = format!("{mlups:.1} MLUPS, {:.0} % of memory speed", 100.0 * share);
        match self.rock() {
            Some(rock) => format!("{fluid}; {}", rock.activity()),
            None => fluid,
        }
    }

    fn conclude(&mut self, summary: &mut Summary, notes: &Notes, steps: u64, time: Duration) {
        // Others may have kept the device busy the first time.
        if let Ok(again) = self.bandwidth() {
            summary.bandwidth = summary.bandwidth.max(again);
        }
        (summary.mlups, summary.bandwidth_share) = speed(summary, steps, time);
        summary.max_mach = self.simulation.units().mach(notes.max_speed);
        let rock = self.rock();
        summary.rocks =
            rock.map(|rock| Rocks::concluded(&rock, self.time_step(), notes, (steps, time)));
        summary.coupling = Coupling::of(&self.simulation, steps);
        self.look_at_walls(summary);
    }
}

/// What a large y⁺ means for the numbers of a run; cells of `finer` m would bring the first centre into
/// the viscous sublayer if the friction stayed the same.
fn y_plus_warning(cell: &FirstCell, beside: &str, finer: f64) -> String {
    let [x, y, z] = cell.position;
    format!(
        "y⁺ is at least {:.0} beside {beside} at ({x:.4}, {y:.4}, {z:.4}) m, above {SUBLAYER}: no-slip \
         shear is not resolved there and there is no wall model, so that friction comes out too small; \
         pressure and the drag of edged bodies suffer less. Cells of {finer:.2e} m would resolve it",
        cell.y_plus
    )
}

/// Million cell updates a second, and the part of what memory allows.
fn speed(summary: &Summary, steps: u64, time: Duration) -> (f64, f64) {
    let rate = steps as f64 / time.as_secs_f64().max(1e-9);
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
