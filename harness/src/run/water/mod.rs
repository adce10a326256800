//! Free water of particles on a device of its own, with the blocks in it, every wait with an end.

mod announce;
mod clouds;
mod energies;
mod gauges;
mod pool;
mod shown;

use super::{
    engine::{Engine, Recorders},
    recorder::Notes,
    rock::{self, BlockFiles, Rock, Rocks},
    summary::Summary,
    views::Views,
};
use crate::gpu;
use clouds::Clouds;
pub use energies::Energies;
use gauges::GaugeTable;
pub use pool::Pool;
use riprap::{
    Result,
    bodies::Ledger,
    checkpoint::WaterCheckpoint,
    particles::{self, Totals, Water},
    scene::{ProbePlace, Quantity, Scene},
    simulation::{FreeSurface, WaterLedger},
    wgpu,
};
use std::{path::Path, rc::Rc, time::Duration};

/// A step of 10⁷ particles takes a CPU adapter minutes; this long, the device hangs.
const PATIENCE: Duration = Duration::from_secs(600);

/// Water on a device.
pub struct Pond {
    pub adapter: wgpu::AdapterInfo,
    pub device: wgpu::Device,
    pub simulation: FreeSurface,
    /// What may disappoint.
    pub warnings: Vec<String>,
    /// Energies of the blocks at the start, those that a restart has not seen included.
    start: Ledger,
    /// Energies of the water at the start, those that a restart has not seen included.
    first: WaterLedger,
    /// The water as it was read last, and at which step: several recorders want it.
    read: Option<(u64, Rc<Water>)>,
    /// Largest speed of the water that was read, m/s.
    fastest: f64,
}

impl Pond {
    /// The scene that was read from `file` at its start, on the adapter called `adapter` or on the best one.
    pub fn open(scene: &Scene, file: &Path, adapter: Option<&str>) -> Result<Self> {
        Self::of(scene, adapter).map_err(|error| crate::search::located(error, file))
    }

    fn of(scene: &Scene, adapter: Option<&str>) -> Result<Self> {
        let adapter = gpu::pick(adapter)?;
        let has = adapter.limits();
        let most = particles::MOST_BINDINGS.max(crate::search::BUFFERS);
        let limits = wgpu::Limits {
            max_storage_buffers_per_shader_stage: most
                .min(has.max_storage_buffers_per_shader_stage),
            max_storage_buffer_binding_size: has.max_storage_buffer_binding_size,
            max_buffer_size: has.max_buffer_size,
            ..wgpu::Limits::downlevel_defaults().using_alignment(has)
        };
        let (device, queue) = gpu::open(&adapter, wgpu::Features::empty(), limits)?;
        let made = FreeSurface::new(&device, &queue, scene);
        let simulation = gpu::drive(&device, PATIENCE, "the kernels", made)??;
        let mut pond = Self {
            adapter: adapter.get_info(),
            start: simulation.blocks().ledger(),
            device,
            simulation,
            warnings: Vec::new(),
            first: WaterLedger::default(),
            read: None,
            fastest: 0.0,
        };
        let water = pond.water()?;
        pond.first = pond.simulation.ledger(&water);
        let simulation = &pond.simulation;
        let setup = simulation.particles().setup();
        let advice = particles::advise(
            scene,
            simulation.setup(),
            simulation.blocks(),
            setup,
            &water.positions,
        );
        let advice = gpu::drive(&pond.device, PATIENCE, "looking for gaps", advice)??;
        let slips = scene.slips(pond.time_step());
        let all = advice.iter().chain(&slips);
        pond.warnings = all.map(ToString::to_string).collect();
        Ok(pond)
    }

    /// The water as it is now.
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

    /// Blocks that are shown, the first ones: the faces of the domain that hold water are none.
    fn shown(&self) -> usize {
        self.simulation.setup().in_fluid + self.simulation.scene().solids.len()
    }
}

impl Engine for Pond {
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
        let shown = self.shown();
        (shown > 0).then(|| Rock {
            step: simulation.step(),
            time: simulation.time(),
            setup: &simulation.setup().setup,
            blocks: simulation.blocks(),
            coupled: None,
            felt: &simulation.felt()[..shown],
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
        gpu::drive(&self.device, PATIENCE, &what, done)?
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
        let (totals, ledger) = match quantities.iter().all(|quantity| quantity.is_of_blocks()) {
            true => Default::default(),
            false => (self.totals()?, self.ledger()?),
        };
        let of_fluid = |quantity| match quantity {
            Quantity::Mass => totals.mass,
            Quantity::MomentumX => totals.momentum[0],
            Quantity::MomentumY => totals.momentum[1],
            Quantity::MomentumZ => totals.momentum[2],
            Quantity::KineticEnergy => totals.kinetic_energy,
            Quantity::PotentialEnergy => ledger.potential,
            Quantity::CompressionEnergy => ledger.compression,
            Quantity::EscapedEnergy => ledger.left,
            Quantity::BodyWork => ledger.bodies,
            Quantity::PushWork => ledger.pushed,
            Quantity::DummyWork => ledger.pressed,
            Quantity::DissipatedEnergy => ledger.dissipated(),
            Quantity::JointWork => ledger.joints,
            Quantity::LostToWater => ledger.blocks,
            Quantity::MaxSpeed => totals.max_speed,
            // A scene without blocks cannot ask for theirs.
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
            pool: Some(Pool::of(self)),
            ..Summary::default()
        })
    }

    fn announce(&self, summary: &Summary, folder: &Path, last: u64) {
        announce::announce(self, summary, folder, last);
    }

    fn pace(&self, summary: &Summary, _: u64, time: Duration) -> String {
        let pool = Pool::of(self).since(summary.pool.as_ref(), time);
        let water = format!("{:.2} million particles/s", pool.updates_a_second / 1e6);
        match self.rock().filter(|_| self.simulation.moves()) {
            Some(rock) => format!("{water}; {}", rock.activity()),
            None => water,
        }
    }

    fn conclude(&mut self, summary: &mut Summary, notes: &Notes, steps: u64, time: Duration) {
        summary.rocks = self.rocks(Rocks::concluded(self, notes, (steps, time)));
        let pool = Pool::of(self).since(summary.pool.as_ref(), time);
        summary.warnings.extend(pool.warnings(self));
        summary.pool = Some(pool);
        // A lost device has told already why there is none.
        summary.water_energies = self.ledger().ok().map(Energies::of);
    }
}

impl Pond {
    /// What blocks do is worth a line only where some can move.
    fn rocks(&self, rocks: Option<Rocks>) -> Option<Rocks> {
        rocks.filter(|_| self.simulation.moves())
    }
}
