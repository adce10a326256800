//! Runs a scene on a device: blocks, a fluid, or both, in one time loop.
//!
//! [`Simulation::new`] takes a device for all kinds of scenes. Blocks without a fluid need none ([`Simulation::of_rock`]).
//!
//! ```
//! use riprap::{scene::{Scene, build::block_setup}, simulation::Simulation};
//!
//! # fn main() -> riprap::Result<()> {
//! let text = r#"
//! [[materials]]
//! name = "rock"
//! density = 2650
//! normal_stiffness = 1e8
//! friction = 35
//! [[blocks]]
//! kind = "box"
//! size = [1, 1, 1]
//! position = [0, 0, 10]
//! [rock]
//! gravity = [0, 0, -10]
//! [run]
//! duration = 0.5
//! "#;
//! let scene = Scene::from_toml(text, ".".as_ref(), "falling.toml")?;
//! let (t, z) = pollster::block_on(async {
//!     let mut simulation = Simulation::of_rock(None, &scene, block_setup(&scene)?).await?;
//!     while simulation.time() < 0.5 {
//!         simulation.advance(1).await?;
//!     }
//!     let t = simulation.time();
//!     let rock = simulation.rock().expect("the scene has blocks");
//!     Ok::<_, riprap::Error>((t, rock.poses()[0].centre.z))
//! })?;
//! assert!((z - (10.0 - 5.0 * t * t)).abs() < 1e-9);
//! # Ok(())
//! # }
//! ```

mod block_fields;
pub mod checkpoint;
mod diverged;
mod fields;
mod flow_control;
mod lattice_fluid;
mod needs;
pub mod probe;
mod restart;
mod sensors;
mod sph_fluid;
mod statistics;
mod wall_friction;
mod wall_units;

pub use crate::gpu::timer::Phase;
pub use block_fields::{block_polyhedra, contact_cloud, face_surface, voigt};
pub use checkpoint::Kind;
pub use fields::{Totals, point_cloud};
pub use flow_control::FlowControlState;
pub use needs::{LatticeNeeds, Needs};
pub use sensors::Reading;
pub use sph_fluid::WaterLedger;
pub use statistics::SamplingState;
pub use wall_friction::{WallFriction, WallFrictions, WallPlace, wall_surface};
pub use wall_units::{FirstCell, SUBLAYER, WallUnits};

use crate::{
    Error, Result,
    coupling::{self, Coupled, ExchangeInterval, FluidLoad, Rock, rock_step},
    geometry::Pose,
    gpu::{Processor, timer::Phases},
    lattice::{Lattice, Setup},
    scene::{
        Advice, Scene,
        build::{BlockSetup, block_setup, lattice_setup},
    },
    sph::{SphSolver, Water},
    units::Units,
};
use lattice_fluid::LatticeFluid;
use sph_fluid::SphFluid;
use std::sync::Arc;

/// A running scene: blocks, a fluid on a lattice or free water (SPH), or blocks in one of these.
///
/// No method blocks: methods that read from the device return a future, and the caller must poll the device while it
/// awaits the future (`wgpu::Device::poll`).
#[derive(Debug)]
pub struct Simulation {
    scene: Arc<Scene>,
    advice: Advice,
    rock: Option<Rock>,
    fluid: Option<Fluid>,
    /// Length of a step, s.
    time_step: f64,
    step: u64,
}

/// The fluid of a scene.
#[derive(Debug)]
enum Fluid {
    Lattice(Box<LatticeFluid>),
    Particles(Box<SphFluid>),
}

impl coupling::Fluid for Fluid {
    fn time(&self) -> f64 {
        match self {
            Self::Lattice(fluid) => fluid.time(),
            Self::Particles(fluid) => fluid.time(),
        }
    }

    async fn advance(
        &mut self,
        poses: &[Pose],
        interval: ExchangeInterval,
        end: f64,
    ) -> Result<Option<Vec<FluidLoad>>> {
        match self {
            Self::Lattice(fluid) => fluid.advance(poses, interval, end).await,
            Self::Particles(fluid) => fluid.advance(poses, interval, end).await,
        }
    }
}

impl Simulation {
    /// Compiles the kernels of a scene and sets its initial state.
    ///
    /// # Errors
    /// If the scene is incomplete, or the device cannot hold it; the errors of [`Rock::new`].
    pub async fn new(device: &wgpu::Device, queue: &wgpu::Queue, scene: &Scene) -> Result<Self> {
        match Kind::of(scene) {
            Kind::Rock => Self::of_rock(Some((device, queue)), scene, block_setup(scene)?).await,
            Kind::Particles => Self::of_water(device, queue, scene).await,
            Kind::Lattice => {
                let units = Units::of(scene)?;
                let processor = scene.run.kernels.processor(&device.adapter_info());
                let cpu = (processor == Processor::Cpu).then(|| device.features());
                let setup = lattice_setup(scene, &units, cpu)?;
                Self::of_lattice(device, queue, scene, setup).await
            }
        }
    }

    /// Like [`Simulation::new`], but takes the setup of the lattice from the [`Needs`] of the scene.
    ///
    /// # Errors
    /// The errors of [`Simulation::new`].
    pub async fn with_needs(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        needs: &Needs,
    ) -> Result<Self> {
        match &needs.lattice {
            Some(lattice) => Self::of_lattice(device, queue, scene, lattice.setup.clone()).await,
            None => Self::new(device, queue, scene).await,
        }
    }

    /// A scene of blocks without a fluid, with the `setup` of [`block_setup`]. Without a `device` the host searches the pairs.
    ///
    /// # Errors
    /// [`Error::Argument`] if the scene has a fluid; [`Error::Scene`] if nothing determines the time step; the errors of
    /// [`Rock::new`].
    pub async fn of_rock(
        device: Option<(&wgpu::Device, &wgpu::Queue)>,
        scene: &Scene,
        setup: BlockSetup,
    ) -> Result<Self> {
        if Kind::of(scene) != Kind::Rock {
            let message = "the scene has a fluid, which needs a device; use Simulation::new";
            return Err(Error::argument("fluid", message));
        }
        let rock = Rock::new(device, scene, setup, None).await?;
        let time_step = rock_step(scene, rock.blocks())?;
        Ok(Self {
            scene: Arc::new(scene.clone()),
            advice: [
                scene.suspicious_keys(time_step),
                rock.setup().advice.clone(),
            ]
            .concat(),
            rock: Some(rock),
            fluid: None,
            time_step,
            step: 0,
        })
    }

    async fn of_water(device: &wgpu::Device, queue: &wgpu::Queue, scene: &Scene) -> Result<Self> {
        let (fluid, rock, time_step) = SphFluid::new(device, queue, scene).await?;
        Ok(Self {
            scene: Arc::new(scene.clone()),
            advice: [
                scene.suspicious_keys(time_step),
                rock.setup().advice.clone(),
            ]
            .concat(),
            rock: Some(rock),
            fluid: Some(Fluid::Particles(Box::new(fluid))),
            time_step,
            step: 0,
        })
    }

    async fn of_lattice(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        setup: Setup,
    ) -> Result<Self> {
        let units = Units::of(scene)?;
        let mut advice = scene.advise(&units)?;
        advice.extend(scene.suspicious_keys(units.time_step));
        let scene = Arc::new(scene.clone());
        let (fluid, rock, of_blocks) =
            LatticeFluid::new(device, queue, (&scene, units), setup).await?;
        advice.extend(of_blocks);
        advice.extend(rock.iter().flat_map(|rock| rock.setup().advice.clone()));
        Ok(Self {
            scene,
            advice,
            rock,
            fluid: Some(Fluid::Lattice(Box::new(fluid))),
            time_step: units.time_step,
            step: 0,
        })
    }

    /// Takes `steps` steps, and checks that the fluid is within the range of the method.
    ///
    /// # Errors
    /// [`Error::Diverged`] and [`Error::ParticleLost`] if the fluid left the range of the method; the errors of
    /// [`Blocks::advance`](crate::rock::Blocks::advance); [`Error::DeviceLost`]. After an error, blocks without a fluid are
    /// in their state after the last whole step. Blocks in a fluid are in their state at the last exchange, and the fluid
    /// is ahead of them; [`Simulation::restore`] returns to a state from which the run can continue.
    pub async fn advance(&mut self, steps: u64) -> Result<()> {
        let last = self.step() + steps;
        while self.step() < last {
            // A lattice records as many steps as it can per submission; other scenes advance step by step.
            let next = match &self.fluid {
                Some(Fluid::Lattice(_)) => last,
                _ => self.step + 1,
            };
            let done = self.advance_to(next as f64 * self.time_step).await;
            match &mut self.fluid {
                Some(Fluid::Lattice(fluid)) => fluid.check(self.rock.as_ref(), done).await?,
                _ => done?,
            }
            self.step = next;
        }
        Ok(())
    }

    /// Advances to the time `end` (s).
    async fn advance_to(&mut self, end: f64) -> Result<()> {
        if let Some(Fluid::Particles(fluid)) = &mut self.fluid {
            // Checkpoints are taken between steps.
            fluid.begin(self.step as f64 * self.time_step);
        }
        match (&mut self.fluid, &mut self.rock) {
            (Some(fluid), Some(rock)) => coupling::run(fluid, rock, end).await,
            (Some(Fluid::Lattice(fluid)), None) => fluid.run(end).await,
            (None, Some(rock)) => rock.advance(end).await,
            // Free water always has a `Rock`, without blocks if the scene has none.
            (Some(Fluid::Particles(_)) | None, None) => Ok(()),
        }
    }

    /// Times the phases of steps from now on; this costs a readback at each exchange.
    pub fn time_phases(&mut self) {
        if let Some(Fluid::Lattice(fluid)) = &mut self.fluid {
            let phases = Phases::new(&fluid.device, &fluid.queue);
            fluid.phases.get_or_insert(phases);
        }
        if let Some(rock) = &mut self.rock {
            rock.time_phases();
        }
    }

    /// Times of the phases of steps since [`Simulation::time_phases`]: the passes of a lattice fluid, the wait for the
    /// readback of its loads, and the phases of the steps of blocks.
    pub fn phases(&self) -> Vec<Phase> {
        let mut phases = match &self.fluid {
            Some(Fluid::Lattice(fluid)) => fluid.phases.as_ref().map(Phases::times),
            _ => None,
        }
        .unwrap_or_default()
        .to_vec();
        let times = self
            .rock
            .as_ref()
            .and_then(|rock| rock.blocks().step_times());
        if let Some(times) = times {
            let phase = |name: &str, seconds| Phase {
                name: name.into(),
                count: times.steps,
                seconds,
            };
            phases.extend([
                phase("broadphase", times.broadphase),
                phase("contact", times.contact),
                phase("integrate", times.integrate),
            ]);
            let steps = times.broadphase + times.contact + times.integrate;
            let spent = self.rock.as_ref().map_or(0.0, Rock::exchange_time_spent);
            if spent > 0.0 {
                phases.push(phase("loads on blocks", (spent - steps).max(0.0)));
            }
        }
        phases
    }

    /// Blocks, a lattice, or free water.
    pub fn kind(&self) -> Kind {
        Kind::of(&self.scene)
    }

    /// Number of steps done.
    pub fn step(&self) -> u64 {
        match &self.fluid {
            // After an error the lattice may have stopped within an advance.
            Some(Fluid::Lattice(fluid)) => fluid.lattice.step(),
            _ => self.step,
        }
    }

    /// Number of steps done by the fluid; free water takes several per step of the scene.
    pub fn fluid_steps(&self) -> u64 {
        self.particles().map_or(self.step(), SphSolver::steps)
    }

    /// Length of a step, s.
    pub fn time_step(&self) -> f64 {
        self.time_step
    }

    /// Simulated time, s.
    pub fn time(&self) -> f64 {
        self.step() as f64 * self.time_step
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Warnings about the scene. [`Simulation::advise_water`] has the warnings that need a readback of free water.
    pub fn advice(&self) -> &Advice {
        &self.advice
    }

    /// The blocks, if there are any.
    pub fn rock(&self) -> Option<&Rock> {
        self.rock.as_ref()
    }

    /// The lattice, if the scene has a fluid on one.
    pub fn lattice(&self) -> Option<&Lattice> {
        Some(&self.lattice_fluid().ok()?.lattice)
    }

    /// The units of the lattice, if there is one.
    pub fn units(&self) -> Option<&Units> {
        Some(&self.lattice_fluid().ok()?.units)
    }

    /// Which cells of the lattice are solid, x fastest; empty if none are.
    pub fn solid(&self) -> &[bool] {
        self.lattice_fluid().map_or(&[], LatticeFluid::solid)
    }

    /// The blocks in a lattice, if there are both.
    pub fn coupled(&self) -> Option<Coupled<'_>> {
        self.lattice_fluid().ok()?.coupled(self.rock())
    }

    /// Number of samples in the field statistics ([`Statistics`](crate::scene::Statistics)); 0 if the scene outputs none.
    pub fn samples(&self) -> u64 {
        self.lattice_fluid().map_or(0, LatticeFluid::samples)
    }

    /// Bytes of the field statistics on the device; 0 if the scene outputs none.
    pub fn statistics_bytes(&self) -> u64 {
        self.lattice_fluid()
            .map_or(0, LatticeFluid::statistics_bytes)
    }

    /// The solver of free water, if there is any.
    pub fn particles(&self) -> Option<&SphSolver> {
        Some(&self.sph_fluid().ok()?.particles)
    }

    /// The present state of free water.
    ///
    /// # Errors
    /// If the scene has no free water, or the device is lost.
    pub async fn water(&mut self) -> Result<Water> {
        match &mut self.fluid {
            Some(Fluid::Particles(fluid)) => fluid.water().await,
            _ => Err(no_water()),
        }
    }

    /// Warnings about free water that the particles resolve poorly at the start; none without free water.
    ///
    /// # Errors
    /// If the device is lost; the errors of the search for gaps.
    pub async fn advise_water(&mut self) -> Result<Advice> {
        match (&mut self.fluid, &self.rock) {
            (Some(Fluid::Particles(fluid)), Some(rock)) => fluid.advise(&self.scene, rock).await,
            _ => Ok(Advice::new()),
        }
    }

    /// Energy ledger of `water`, the present state.
    ///
    /// # Errors
    /// If the scene has no free water.
    pub fn ledger(&self, water: &Water) -> Result<WaterLedger> {
        let work = self.rock.as_ref().map_or(0.0, |rock| rock.work_on_fluid);
        Ok(self.sph_fluid()?.ledger(water, work))
    }

    /// Measurement of the pressure sensor `name` in free water; `None` if there is no such probe.
    pub fn sensor(&self, name: &str) -> Option<Reading> {
        self.sph_fluid().ok()?.sensor(name)
    }

    /// Steps of free water that sorted the particles and rebuilt the neighbour lists, if there are any; zero without free
    /// water.
    pub fn sorts(&self) -> u64 {
        self.sph_fluid().map_or(0, |fluid| fluid.sorts)
    }

    fn lattice_fluid(&self) -> Result<&LatticeFluid> {
        match &self.fluid {
            Some(Fluid::Lattice(fluid)) => Ok(fluid),
            _ => Err(no_lattice()),
        }
    }

    fn lattice_and_rock(&mut self) -> Result<(&mut LatticeFluid, Option<&Rock>)> {
        match &mut self.fluid {
            Some(Fluid::Lattice(fluid)) => Ok((fluid, self.rock.as_ref())),
            _ => Err(no_lattice()),
        }
    }

    fn sph_fluid(&self) -> Result<&SphFluid> {
        match &self.fluid {
            Some(Fluid::Particles(fluid)) => Ok(fluid),
            _ => Err(no_water()),
        }
    }
}

fn no_lattice() -> Error {
    let message =
        "these fields need a fluid on a lattice, and the scene has none; give it fluid.viscosity";
    Error::argument("fluid", message)
}

fn no_water() -> Error {
    Error::argument(
        "particles",
        "the scene has no free water; add [particles] and [[water]]",
    )
}
