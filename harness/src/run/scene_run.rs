//! A scene on its own device, or on the host for blocks without a fluid that need no device.

mod recorders;

use super::{
    lattice::{Coupling, LatticeSummary},
    recorder::RunLog,
    rock::{Rock, Rocks},
    skipped_work::SkippedWork,
    summary::Summary,
    throughput::Throughput,
    views::solid_blocks,
    water::{Energies, WaterSummary},
};
use crate::{bench::copy_bandwidth, broadphase, gpu};
use riprap::{
    Error, Result,
    lattice::{Lattice, Memory},
    output::{Array, ImageData},
    rock::{Block, EnergyLedger},
    scene::{Field, Scene, build::block_setup},
    simulation::{
        Kind, Needs, Simulation, Totals, WallFrictions, WallUnits, WaterLedger,
        checkpoint::Checkpoint,
    },
    sph::{self, Water},
    units::Units,
    wgpu,
};
use std::{path::Path, rc::Rc, time::Duration};

/// Bytes that are copied to measure the memory bandwidth: more than caches hold.
const BYTES: u64 = 128 << 20;

/// Number of evaluations of the largest speed in a run, besides those of the histories: too few to cost time.
const LOOKS: f64 = 20.0;

/// Timeout of a wait. A step of 10⁸ cells or 10⁷ particles takes a CPU adapter minutes, and a step with the most sub-steps
/// of contacts that a run may have takes a quarter of an hour.
const PATIENCE: Duration = Duration::from_secs(1800);

/// A running scene.
pub struct SceneRun {
    /// The scene.
    pub simulation: Simulation,
    /// Device of the run; `None` for blocks with a broadphase on the host.
    pub device: Option<(wgpu::Device, wgpu::Queue)>,
    /// Adapter of the device.
    pub adapter: Option<wgpu::AdapterInfo>,
    /// Bytes and bindings of a lattice.
    pub memory: Option<Memory>,
    /// Warnings about the scene.
    pub warnings: Vec<String>,
    /// Largest speed of water in all readbacks, m/s.
    pub max_water_speed: f64,
    /// Static solids of a lattice without blocks, if there are views of them.
    pub(super) solids: Vec<Block>,
    /// Part of the name of the adapter to draw on.
    drawing_adapter: Option<String>,
    /// Energies of the blocks at the start of the scene, before any restart.
    start: EnergyLedger,
    /// Energies of the water at the start of the scene, before any restart.
    water_start: WaterLedger,
    /// Step and state of the last readback of water, which several recorders share.
    last_water: Option<(u64, Rc<Water>)>,
}

/// Completes a future, polling the device if there is one.
fn drive<T>(
    device: Option<&(wgpu::Device, wgpu::Queue)>,
    what: &str,
    future: impl Future<Output = Result<T>>,
) -> Result<T> {
    match device {
        Some((device, _)) => gpu::drive(device, PATIENCE, what, future)?,
        None => pollster::block_on(future),
    }
}

impl SceneRun {
    /// Opens the scene that was read from `file`, at its start, on the adapter called `adapter` or on the best one.
    pub fn open(scene: &Scene, file: &Path, adapter: Option<&str>) -> Result<Self> {
        Self::of(scene, adapter).map_err(|error| broadphase::located(error, file))
    }

    fn of(scene: &Scene, name: Option<&str>) -> Result<Self> {
        let kind = Kind::of(scene);
        let blocks = match kind {
            Kind::Rock => Some(block_setup(scene)?),
            Kind::Lattice | Kind::Particles => None,
        };
        let adapter = match &blocks {
            Some(blocks) => broadphase::adapter(scene, blocks, name)?,
            None => Some(gpu::pick(name)?),
        };
        let (mut device, mut needs) = (None, None);
        if let Some(adapter) = &adapter {
            let of_scene = needs.insert(Needs::of(scene, adapter)?);
            let limits = of_scene.limits.clone();
            device = Some(gpu::open(adapter, of_scene.features, limits)?);
        }
        let pair = device.as_ref().map(|(device, queue)| (device, queue));
        let mut simulation = drive(device.as_ref(), "the kernels", async {
            match (blocks, pair, &needs) {
                (Some(blocks), pair, _) => Simulation::of_rock(pair, scene, blocks).await,
                (None, Some((device, queue)), Some(needs)) => {
                    Simulation::with_needs(device, queue, scene, needs).await
                }
                // Simulation refuses this: only blocks without a fluid may lack a device.
                _ => Simulation::of_rock(None, scene, block_setup(scene)?).await,
            }
        })?;
        let advice = drive(
            device.as_ref(),
            "looking for gaps",
            simulation.advise_water(),
        )?;
        let all = advice.iter().chain(simulation.advice());
        let solids = !scene.views.is_empty() && simulation.rock().is_none();
        let info = adapter.map(|adapter| adapter.get_info());
        let mut run = Self {
            warnings: all.map(ToString::to_string).collect(),
            start: simulation
                .rock()
                .map_or_else(EnergyLedger::default, |rock| rock.blocks().ledger()),
            memory: needs
                .and_then(|needs| needs.lattice)
                .map(|lattice| lattice.memory),
            solids: if solids {
                solid_blocks(scene)
            } else {
                Vec::new()
            },
            // Pictures are drawn on the adapter that computes the fluid.
            drawing_adapter: match (&info, kind) {
                (Some(info), Kind::Lattice | Kind::Particles) => Some(info.name.clone()),
                _ => name.map(Into::into),
            },
            adapter: info,
            device,
            simulation,
            water_start: WaterLedger::default(),
            last_water: None,
            max_water_speed: 0.0,
        };
        run.check_probes()?;
        if kind == Kind::Particles {
            let water = run.water()?;
            run.water_start = run.simulation.ledger(&water)?;
        }
        Ok(run)
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        self.simulation.scene()
    }

    /// Steps done.
    pub fn step(&self) -> u64 {
        self.simulation.step()
    }

    /// Length of a step, s.
    pub fn time_step(&self) -> f64 {
        self.simulation.time_step()
    }

    /// Simulated time, s.
    pub fn time(&self) -> f64 {
        self.simulation.time()
    }

    /// The lattice and its units, if the scene has a lattice.
    pub fn lattice(&self) -> Option<(&Lattice, &Units)> {
        self.simulation.lattice().zip(self.simulation.units())
    }

    /// The present blocks, if the scene has any.
    pub fn rock(&self) -> Option<Rock<'_>> {
        let simulation = &self.simulation;
        let rock = simulation.rock()?;
        let in_fluid = rock.setup().in_fluid;
        // The blocks that represent faces of the domain come last and are not shown.
        let in_domain = in_fluid + self.scene().solids.len();
        let (shown, loaded) = match simulation.kind() {
            Kind::Rock => (rock.blocks().len(), 0),
            Kind::Lattice => (in_domain, in_fluid),
            Kind::Particles => (in_domain, in_domain),
        };
        (shown > 0).then(|| Rock {
            step: simulation.step(),
            time: simulation.time(),
            setup: &rock.setup().setup,
            blocks: rock.blocks(),
            loads: &rock.external_load()[..loaded],
            coupled: simulation.coupled(),
            shown,
            start: &self.start,
        })
    }

    /// Whether its state is worth writing after steps that left the range of the method: blocks without a fluid return to
    /// the last good step.
    pub fn is_intact(&self) -> bool {
        self.simulation.kind() == Kind::Rock
    }

    /// Takes `steps` steps; the device is idle at their end.
    pub fn advance(&mut self, steps: u64) -> Result<()> {
        let what = format!("{steps} steps");
        drive(self.device.as_ref(), &what, self.simulation.advance(steps))?;
        if let Some((device, _)) = &self.device {
            // Without this wait, the time of free water without blocks would count as output.
            let all = wgpu::PollType::Wait {
                submission_index: None,
                timeout: Some(PATIENCE),
            };
            let idle = device.poll(all);
            idle.map_err(|error| Error::DeviceLost(error.to_string()))?;
        }
        Ok(())
    }

    /// Restores the state from a checkpoint.
    pub fn restore(&mut self, path: &Path) -> Result<()> {
        self.last_water = None;
        self.simulation.restore(&Checkpoint::read(path)?)
    }

    /// Writes a checkpoint, from which a run continues bitwise.
    pub fn checkpoint(&mut self, path: &Path) -> Result<()> {
        let state = self.simulation.checkpoint();
        drive(self.device.as_ref(), "reading the state", state)?.write(path)
    }

    /// The given fields on all cells of the lattice.
    pub fn image(&mut self, fields: &[Field]) -> Result<ImageData> {
        let image = self.simulation.image(fields);
        drive(self.device.as_ref(), "reading the fields", image)
    }

    /// Sums over the lattice.
    pub fn totals(&mut self) -> Result<Totals> {
        let totals = self.simulation.totals();
        drive(self.device.as_ref(), "summing up", totals)
    }

    /// The given fields on the given cells of the lattice; none without a lattice, where pictures need none.
    pub fn read(&mut self, fields: &[Field], cells: &[u32]) -> Result<Vec<Array>> {
        if self.simulation.lattice().is_none() {
            return Ok(Vec::new());
        }
        let read = self.simulation.read(fields, cells);
        drive(self.device.as_ref(), "reading cells", read)
    }

    /// The largest y⁺ at walls and blocks of the lattice.
    pub fn wall_units(&mut self) -> Result<WallUnits> {
        let found = self.simulation.wall_units();
        drive(self.device.as_ref(), "reading cells beside walls", found)
    }

    /// The friction on walls with a wall model.
    pub fn wall_friction(&mut self) -> Result<WallFrictions> {
        let found = self.simulation.wall_friction();
        drive(self.device.as_ref(), "reading the friction of walls", found)
    }

    /// The present state of free water.
    pub fn water(&mut self) -> Result<Rc<Water>> {
        let step = self.simulation.step();
        if let Some((read, water)) = &self.last_water
            && *read == step
        {
            return Ok(water.clone());
        }
        let water = self.simulation.water();
        let water = Rc::new(drive(self.device.as_ref(), "reading the water", water)?);
        self.last_water = Some((step, water.clone()));
        let totals = self.water_totals()?;
        self.max_water_speed = self.max_water_speed.max(totals.max_speed);
        Ok(water)
    }

    /// Sums over the particles of free water.
    pub(super) fn water_totals(&mut self) -> Result<sph::Totals> {
        let water = self.water()?;
        let setup = self.simulation.particles().map(sph::SphSolver::setup);
        let totals = setup.map(|setup| sph::Totals::of(setup, &water));
        Ok(totals.unwrap_or_default())
    }

    /// Energies of free water since the start of the scene.
    pub(super) fn water_ledger(&mut self) -> Result<WaterLedger> {
        let water = self.water()?;
        Ok(self.simulation.ledger(&water)?.since(&self.water_start))
    }

    /// The device of the run, in one line.
    pub fn describe_device(&self) -> String {
        let adapter = self.adapter.as_ref().map(gpu::describe);
        match (adapter, self.simulation.kind()) {
            (Some(adapter), Kind::Rock) => format!("pairs on {adapter}"),
            (Some(adapter), _) => adapter,
            (None, _) => "pairs on the host".into(),
        }
    }

    /// The summary of the blocks; `None` for free water in which no block moves.
    fn rocks(&self, rocks: Option<Rocks>) -> Option<Rocks> {
        let is_still = |rock: &riprap::coupling::Rock| !rock.moves();
        let still = self.simulation.rock().is_some_and(is_still);
        rocks.filter(|_| !(still && self.simulation.kind() == Kind::Particles))
    }

    /// The summary before the first step.
    pub fn summary(&self) -> Result<Summary> {
        let lattice = self.lattice();
        Ok(Summary {
            title: self.scene().title.clone(),
            adapter: self.describe_device(),
            lattice: LatticeSummary::of(self)?,
            time_step: self.time_step(),
            first_step: self.step(),
            warnings: self.warnings.clone(),
            coupling: Coupling::of(&self.simulation, 0),
            rocks: self.rocks(Rocks::of(self)),
            pool: WaterSummary::of(self),
            left_out: lattice
                .map_or_else(Vec::new, |(lattice, _)| SkippedWork::of_lattice(lattice)),
            ..Summary::default()
        })
    }

    /// Copy bandwidth of the device, bytes per second.
    pub fn bandwidth(&self) -> Result<f64> {
        match &self.device {
            Some((device, queue)) => copy_bandwidth(device, queue, BYTES),
            None => Ok(0.0),
        }
    }

    /// The speed of the run, in a few words.
    pub fn describe(&self, summary: &Summary, throughput: &Throughput) -> String {
        let activity = self.rock().map(|rock| rock.activity());
        let fluid = match self.simulation.kind() {
            Kind::Rock => {
                let warm = throughput.warm();
                let rate = warm.rate(warm.steps);
                return format!("{rate:.0} steps/s, {}", activity.unwrap_or_default());
            }
            Kind::Lattice => {
                let lattice = summary.lattice.as_ref();
                let now = lattice.map(|lattice| lattice.at_speed(throughput));
                let now = now.unwrap_or_default();
                let share = 100.0 * now.bandwidth_share;
                format!("{:.1} MLUPS, {share:.0} % of memory speed", now.mlups)
            }
            Kind::Particles => {
                let pool = WaterSummary::of(self);
                let pool = pool.map(|pool| pool.since(summary.pool.as_ref(), throughput));
                let updates = pool.map_or(0.0, |pool| pool.updates_a_second);
                format!("{:.2} million particle updates/s", updates / 1e6)
            }
        };
        match activity.filter(|_| summary.rocks.is_some()) {
            Some(activity) => format!("{fluid}; {activity}"),
            None => fluid,
        }
    }

    /// Completes the summary after the last step.
    pub fn finish(&mut self, summary: &mut Summary, log: &RunLog, throughput: &Throughput) {
        summary.rocks = self.rocks(Rocks::finished(self, log, throughput));
        match self.simulation.kind() {
            Kind::Rock => {}
            Kind::Lattice => {
                let lattice = summary.lattice.take();
                summary.lattice = lattice.map(|l| l.finished(self, log, throughput));
                let warning = summary.lattice.as_ref().and_then(|l| l.warning(self, log));
                summary.warnings.extend(warning);
                summary.warnings.extend(LatticeSummary::flow_warning(self));
                summary.coupling = Coupling::of(&self.simulation, throughput.whole().steps);
                self.report_wall_units(summary);
                self.report_wall_model(summary);
            }
            Kind::Particles => {
                if let Some(pool) = WaterSummary::of(self) {
                    let pool = pool.since(summary.pool.as_ref(), throughput);
                    summary.warnings.extend(pool.warnings(self));
                    summary.pool = Some(pool);
                }
                // If the device is lost, the run has already reported the error.
                summary.water_energies = self.water_ledger().ok().map(Energies::of);
            }
        }
    }
}
