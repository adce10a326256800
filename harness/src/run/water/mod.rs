//! Runs of scenes with free-surface water (SPH) and blocks on a device of their own. Every wait has a timeout.

mod announce;
mod clouds;
mod energies;
mod gauges;
mod shown;
mod water_summary;

use super::{
    engine::{Engine, Recorders},
    pace::Pace,
    recorder::Notes,
    rock::{self, BlockFiles, Rock, Rocks},
    summary::Summary,
    views::Views,
};
use crate::gpu;
use clouds::Clouds;
pub use energies::Energies;
use gauges::GaugeTable;
use riprap::{
    Error, Result,
    coupling::particle_advice,
    rock::EnergyLedger,
    scene::{ProbePlace, Quantity, Scene},
    simulation::{FreeSurface, WaterLedger, checkpoint::WaterCheckpoint},
    sph::{self, Totals, Water},
    wgpu,
};
use std::{path::Path, rc::Rc, time::Duration};
pub use water_summary::WaterSummary;

/// Timeout of a wait: a step of 10⁷ particles takes a CPU adapter minutes.
const PATIENCE: Duration = Duration::from_secs(600);

/// A run of a scene with free water.
pub struct SphRun {
    pub adapter: wgpu::AdapterInfo,
    pub device: wgpu::Device,
    pub simulation: FreeSurface,
    /// Warnings about the scene.
    pub warnings: Vec<String>,
    /// Energies of the blocks at the start of the scene, before any restart.
    start: EnergyLedger,
    /// Energies of the water at the start of the scene, before any restart.
    first: WaterLedger,
    /// Step and state of the last readback, which several recorders share.
    read: Option<(u64, Rc<Water>)>,
    /// Largest speed of all readbacks, m/s.
    fastest: f64,
}

impl SphRun {
    /// The run of `scene`, read from `file`, on the adapter named `adapter` or on the best one.
    pub fn open(scene: &Scene, file: &Path, adapter: Option<&str>) -> Result<Self> {
        Self::of(scene, adapter).map_err(|error| crate::search::located(error, file))
    }

    fn of(scene: &Scene, adapter: Option<&str>) -> Result<Self> {
        let adapter = gpu::pick(adapter)?;
        let has = adapter.limits();
        let most = sph::MAX_STORAGE_BUFFERS.max(crate::search::BUFFERS);
        let limits = wgpu::Limits {
            max_storage_buffers_per_shader_stage: most
                .min(has.max_storage_buffers_per_shader_stage),
            max_storage_buffer_binding_size: has.max_storage_buffer_binding_size,
            max_buffer_size: has.max_buffer_size,
            ..wgpu::Limits::downlevel_defaults().using_alignment(has)
        };
        let (device, queue) = gpu::open(&adapter, wgpu::Features::empty(), limits)?;
        let simulation = FreeSurface::new(&device, &queue, scene);
        let simulation = gpu::drive(&device, PATIENCE, "the kernels", simulation)??;
        let mut run = Self {
            adapter: adapter.get_info(),
            start: simulation.blocks().ledger(),
            device,
            simulation,
            warnings: Vec::new(),
            first: WaterLedger::default(),
            read: None,
            fastest: 0.0,
        };
        let water = run.water()?;
        run.first = run.simulation.ledger(&water);
        let simulation = &run.simulation;
        let setup = simulation.particles().setup();
        let advice = particle_advice(
            scene,
            simulation.setup(),
            simulation.blocks(),
            setup,
            &water.positions,
        );
        let advice = gpu::drive(&run.device, PATIENCE, "looking for gaps", advice)??;
        let slips = scene.slips(run.time_step());
        let all = advice.iter().chain(&slips);
        run.warnings = all.map(ToString::to_string).collect();
        Ok(run)
    }

    /// The present state of the water.
    pub fn water(&mut self) -> Result<Rc<Water>> {
        let step = self.simulation.step();
        if let Some((read, water)) = &self.read
            && *read == step
        {
            return Ok(water.clone());
        }
        let water = self.simulation.water();
        let water = Rc::new(gpu::drive(
            &self.device,
            PATIENCE,
            "reading the water",
            water,
        )??);
        let totals = Totals::of(self.simulation.particles().setup(), &water);
        self.fastest = self.fastest.max(totals.max_speed);
        self.read = Some((step, water.clone()));
        Ok(water)
    }

    fn totals(&mut self) -> Result<Totals> {
        let water = self.water()?;
        Ok(Totals::of(self.simulation.particles().setup(), &water))
    }

    /// Energies since the start of the scene.
    fn ledger(&mut self) -> Result<WaterLedger> {
        let water = self.water()?;
        Ok(self.simulation.ledger(&water).since(&self.first))
    }

    /// Number of blocks in the output, which come first; walls of the domain come last.
    fn shown(&self) -> usize {
        self.simulation.setup().in_fluid + self.simulation.scene().solids.len()
    }
}

impl Engine for SphRun {
    fn scene(&self) -> &Scene {
        self.simulation.scene()
    }

    fn step(&self) -> u64 {
        self.simulation.step()
    }

    fn fluid_steps(&self) -> u64 {
        self.simulation.particles().steps()
    }

    fn time_step(&self) -> f64 {
        self.simulation.time_step()
    }

    fn time(&self) -> f64 {
        self.simulation.time()
    }

    fn rock(&self) -> Option<Rock<'_>> {
        let simulation = &self.simulation;
        let shown = self.shown();
        (shown > 0).then(|| Rock {
            step: simulation.step(),
            time: simulation.time(),
            setup: &simulation.setup().setup,
            blocks: simulation.blocks(),
            coupled: None,
            felt: &simulation.external_load()[..shown],
            shown,
            start: &self.start,
        })
    }

    fn is_good(&self) -> bool {
        false
    }

    fn advance(&mut self, steps: u64) -> Result<()> {
        let what = format!("{steps} steps");
        let done = self.simulation.advance(steps);
        gpu::drive(&self.device, PATIENCE, &what, done)??;
        // Without blocks `advance` returns before the device completes the steps; their time would count as output.
        let all = wgpu::PollType::Wait {
            submission_index: None,
            timeout: Some(PATIENCE),
        };
        let idle = self.device.poll(all);
        idle.map_err(|error| Error::DeviceLost(error.to_string()))?;
        Ok(())
    }

    fn restore(&mut self, path: &Path) -> Result<()> {
        self.read = None;
        self.simulation.restore(&WaterCheckpoint::read(path)?)
    }

    fn checkpoint(&mut self, path: &Path) -> Result<()> {
        let checkpoint = self.simulation.checkpoint();
        gpu::drive(&self.device, PATIENCE, "reading the state", checkpoint)??.write(path)
    }

    fn values(&mut self, quantities: &[Quantity], notes: &mut Notes) -> Result<Vec<f64>> {
        let needs_water = !quantities.iter().all(|quantity| quantity.is_of_blocks());
        let (totals, ledger) = if needs_water {
            (self.totals()?, self.ledger()?)
        } else {
            Default::default()
        };
        let of_fluid = |quantity| match quantity {
            Quantity::Mass => totals.mass,
            Quantity::MomentumX => totals.momentum[0],
            Quantity::MomentumY => totals.momentum[1],
            Quantity::MomentumZ => totals.momentum[2],
            Quantity::KineticEnergy => totals.kinetic_energy,
            Quantity::PotentialEnergy => ledger.potential,
            Quantity::CompressionEnergy => ledger.compression,
            Quantity::EscapedEnergy => ledger.escaped,
            Quantity::BodyWork => ledger.bodies,
            Quantity::PushWork => ledger.penalty,
            Quantity::DummyWork => ledger.boundary,
            Quantity::DissipatedEnergy => ledger.dissipated(),
            Quantity::JointWork => ledger.joints,
            Quantity::LostToWater => ledger.blocks,
            Quantity::MaxSpeed => totals.max_speed,
            // Quantities of blocks are not available without blocks.
            _ => f64::NAN,
        };
        Ok(rock::values(self.rock(), quantities, notes, of_fluid))
    }

    fn recorders(&mut self, folder: &Path, last: u64) -> anyhow::Result<Recorders<Self>> {
        let scene = self.scene().clone();
        let mut recorders: Recorders<Self> = vec![Box::new(Clouds::new(self, folder, last)?)];
        for probe in &scene.probes {
            if let ProbePlace::Block { block, safety, .. } = &probe.place {
                let asked = [false, *safety];
                recorders.extend(rock::probes(self, folder, last, (probe, block), asked)?);
            } else {
                recorders.push(Box::new(GaugeTable::new(self, folder, last, probe)?));
            }
        }
        if self.shown() > 0 {
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
        Ok(Summary {
            title: simulation.scene().title.clone(),
            adapter: gpu::describe(&self.adapter),
            time_step: simulation.time_step(),
            first_step: simulation.step(),
            warnings: self.warnings.clone(),
            rocks: self.rocks(Rocks::of(self)),
            pool: Some(WaterSummary::of(self)),
            ..Summary::default()
        })
    }

    fn announce(&self, summary: &Summary, folder: &Path, last: u64) {
        announce::announce(self, summary, folder, last);
    }

    fn describe_pace(&self, summary: &Summary, pace: &Pace) -> String {
        let pool = WaterSummary::of(self).since(summary.pool.as_ref(), pace);
        let water = format!(
            "{:.2} million particle updates/s",
            pool.updates_a_second / 1e6
        );
        match self.rock().filter(|_| self.simulation.moves()) {
            Some(rock) => format!("{water}; {}", rock.activity()),
            None => water,
        }
    }

    fn conclude(&mut self, summary: &mut Summary, notes: &Notes, pace: &Pace) {
        summary.rocks = self.rocks(Rocks::concluded(self, notes, pace));
        let pool = WaterSummary::of(self).since(summary.pool.as_ref(), pace);
        summary.warnings.extend(pool.warnings(self));
        summary.pool = Some(pool);
        // On a lost device the run has already reported the error.
        summary.water_energies = self.ledger().ok().map(Energies::of);
    }
}

impl SphRun {
    /// The summary of the blocks if any can move.
    fn rocks(&self, rocks: Option<Rocks>) -> Option<Rocks> {
        rocks.filter(|_| self.simulation.moves())
    }
}
