//! Free water (SPH), its exchanges with the blocks, and its energy ledger.

use super::{
    Reading,
    checkpoint::{WaterState, other_scene},
    sensors::Sensors,
};
use crate::{
    Error, Result,
    coupling::{
        CouplingParams, ExchangeInterval, Fluid, FluidLoad, JointSeal, Rock, check_substep_count,
        longest_exchange, particle_advice,
    },
    error::{error_chain, refused},
    geometry::{Load, Pose},
    gpu::Processor,
    rock::Motion,
    scene::{
        Advice, Scene,
        build::{block_setup, particle_key, particle_setup, scene_step},
    },
    sph::{NeighbourSearch, SphSolver, Totals, Water},
};
use glam::{DMat3, DVec3};

/// The water of a scene and its exchanges with the blocks.
#[derive(Debug)]
pub(super) struct SphFluid {
    device: wgpu::Device,
    queue: wgpu::Queue,
    pub particles: SphSolver,
    joint_seal: JointSeal,
    /// Blocks with a load in the last exchange of the step; at its start all blocks. Only their joints can hold water.
    wet: Vec<bool>,
    /// Longest time between two exchanges while blocks may move, s.
    longest: f64,
    time: f64,
    average: bool,
    /// Mean loads of the last exchange; empty before the first one.
    last: Vec<Load>,
    /// Work of blocks since the start in joints that have no particles, J.
    joints: f64,
    /// Steps that sorted the particles.
    pub sorts: u64,
    sensors: Sensors,
}

impl Fluid for SphFluid {
    fn time(&self) -> f64 {
        self.time
    }

    async fn advance(
        &mut self,
        poses: &[Pose],
        interval: ExchangeInterval,
        end: f64,
    ) -> Result<Option<Vec<FluidLoad>>> {
        let until = self.next(interval, end);
        let (device, queue, time) = (&self.device, &self.queue, until - self.time);
        let sealed = self.joint_seal.find_joints(poses, &self.wet);
        let rims = sealed.rim_places();
        self.particles
            .set_probes(device, queue, &rims, self.sensors.probes())?;
        let mut done = self.particles.advance(device, queue, poses, time).await?;
        let own = done.loads.clone();
        let loads = &mut done.loads;
        let (rims, walls) = done.pressures.split_at(rims.len());
        self.joint_seal.add_loads(sealed, rims, poses, loads);
        if self.particles.setup().plane {
            loads.iter_mut().for_each(|load| *load = load.in_plane());
        }
        self.sensors.record(walls, time);
        self.joints += joints_work(&own, loads, poses, time);
        let wet = |load: &Load| load.force != DVec3::ZERO;
        self.wet = done.loads.iter().map(wet).collect();
        self.time = until;
        self.sorts += u64::from(done.sorts);
        if !self.average || self.last.is_empty() {
            self.last.clone_from(&done.loads);
        }
        let mean = |(last, new): (&Load, &Load)| FluidLoad {
            flow: Load {
                force: 0.5 * (last.force + new.force),
                moment: 0.5 * (last.moment + new.moment),
                ..Load::default()
            },
            buoyancy: Load::default(),
        };
        let loads = self.last.iter().zip(&done.loads).map(mean).collect();
        self.last = done.loads;
        Ok(Some(loads))
    }
}

impl SphFluid {
    /// The water of a scene at its start, its blocks, and the length of a step, s.
    ///
    /// # Errors
    /// [`Error::Scene`] if the scene is invalid; [`Error::Limit`] or [`Error::Device`] if the device cannot hold it.
    pub async fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
    ) -> Result<(Self, Rock, f64)> {
        let setup = block_setup(scene)?;
        let (mut water, start) = particle_setup(scene, &setup)?;
        match scene.run.kernels.processor(&device.adapter_info()) {
            Processor::Cpu => water.neighbours = NeighbourSearch::Lists,
            Processor::Gpu => water.batched_neighbours = true,
        }
        let time_step = scene_step(scene, water.acoustic_step());
        let params = CouplingParams {
            time_step,
            // The tolerance covers the rounding of exchange times.
            hold: scene.coupling.hold * (1.0 - 1e-12),
            inside: None,
        };
        let rock = Rock::new(Some((device, queue)), scene, setup, Some(params)).await?;
        check_substep_count(time_step, rock.blocks())?;
        let make = async {
            SphSolver::new(
                device,
                queue,
                water,
                &start.positions,
                &start.velocities,
                &start.pressures,
            )
        };
        let (particles, refused) = refused(device, make).await;
        let particles = particles.map_err(|error| error.at_key(particle_key))?;
        if let Some(error) = refused {
            return Err(Error::Device(format!(
                "it does not hold {} particles ({}); use a larger spacing",
                particles.counts().fluid,
                error_chain(&error)
            )));
        }
        let blocks = &rock.setup().setup.blocks;
        let shapes = blocks.iter().map(|block| block.shape.clone()).collect();
        let loaded: Vec<bool> = blocks
            .iter()
            .map(|block| block.motion == Motion::Free || scene.probes_block(&block.name))
            .collect();
        let setup = particles.setup();
        let fluid = Self {
            wet: vec![true; setup.bodies.len()],
            device: device.clone(),
            queue: queue.clone(),
            joint_seal: JointSeal::new(shapes, rock.blocks().periods().cloned(), setup, &loaded),
            longest: longest_exchange(&rock, setup.density * setup.sound_speed),
            sensors: Sensors::of(scene, setup, blocks),
            particles,
            time: 0.0,
            average: scene.averages_loads(),
            last: Vec::new(),
            joints: 0.0,
            sorts: 0,
        };
        Ok((fluid, rock, time_step))
    }

    /// Begins a step at `time` (s). The step depends only on state that a checkpoint contains.
    pub fn begin(&mut self, time: f64) {
        self.time = time;
        self.wet.fill(true);
        self.sensors.begin();
        self.particles.force_sort();
    }

    /// Time of the next exchange. The exchanges until `end` are of equal length.
    fn next(&self, interval: ExchangeInterval, end: f64) -> f64 {
        let interval = match interval {
            ExchangeInterval::Static => return end,
            ExchangeInterval::Asleep(steps) => steps as f64 * self.particles.step_limit(),
            ExchangeInterval::Awake { steps, .. } => {
                (steps as f64 * self.particles.step_limit()).min(self.longest)
            }
        };
        let parts = ((end - self.time) / interval * (1.0 - 1e-6))
            .ceil()
            .max(1.0);
        if parts == 1.0 {
            end
        } else {
            self.time + (end - self.time) / parts
        }
    }

    /// The present state of the water.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn water(&mut self) -> Result<Water> {
        self.particles.water(&self.device, &self.queue).await
    }

    /// Measurement of the sensor `name`; `None` if there is no such probe.
    pub fn sensor(&self, name: &str) -> Option<Reading> {
        self.sensors.reading(name)
    }

    /// Warnings about the water of `scene` and the blocks in it.
    ///
    /// # Errors
    /// If the device is lost; the errors of the search for gaps.
    pub async fn advise(&mut self, scene: &Scene, rock: &Rock) -> Result<Advice> {
        let water = self.water().await?;
        let setup = self.particles.setup();
        particle_advice(scene, rock.setup(), rock.blocks(), setup, &water.positions).await
    }

    /// Energy ledger of `water`, the present state; `blocks` is the work of the blocks on it, J.
    pub fn ledger(&self, water: &Water, blocks: f64) -> WaterLedger {
        let totals = Totals::of(self.particles.setup(), water);
        let work = self.particles.work();
        WaterLedger {
            kinetic: totals.kinetic_energy,
            potential: totals.potential_energy - work.gravity,
            compression: totals.compression_energy,
            escaped: water.escaped.energy(),
            bodies: work.bodies,
            penalty: work.penalty,
            boundary: work.boundary,
            joints: self.joints,
            blocks,
        }
    }

    /// The present state, of the water of `scene`.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn state(&mut self, scene: &Scene) -> Result<WaterState> {
        Ok(WaterState {
            origin: DVec3::from(scene.domain.origin),
            size: DVec3::from(scene.domain.size),
            spacing: self.particles.setup().spacing,
            particles: self.particles.particles(&self.device, &self.queue).await?,
            solver: self.particles.state(),
            loads: self.last.clone(),
            joints: self.joints,
            sensors: self.sensors.readings.clone(),
        })
    }

    /// Checks that a state belongs to the water of `scene`.
    ///
    /// # Errors
    /// [`Error::Argument`] if its domain, particles or sensors differ.
    pub fn check_state(&self, scene: &Scene, state: &WaterState) -> Result<()> {
        let domain = |origin: DVec3, size: DVec3, spacing: f64| {
            format!("a domain from {origin} m, {size} m wide, with particles every {spacing} m")
        };
        let own = [scene.domain.origin, scene.domain.size].map(DVec3::from);
        let spacing = self.particles.setup().spacing;
        if [state.origin, state.size] != own || state.spacing != spacing {
            return Err(other_scene(
                domain(state.origin, state.size, state.spacing),
                domain(own[0], own[1], spacing),
            ));
        }
        let (its, own) = (state.sensors.len(), self.sensors.readings.len());
        if its != own {
            return Err(Error::argument(
                "restart",
                format!(
                    "the checkpoint has {its} pressure sensors and the scene {own}; restart with the scene that wrote it"
                ),
            ));
        }
        self.particles.check(&state.particles)
    }

    /// Restores a state that [`SphFluid::check_state`] accepts.
    ///
    /// # Errors
    /// The errors of the solver.
    pub fn restore(&mut self, state: &WaterState) -> Result<()> {
        self.sensors.readings.clone_from(&state.sensors);
        self.particles
            .restore(&self.queue, &state.particles, &state.solver)?;
        self.last.clone_from(&state.loads);
        self.joints = state.joints;
        Ok(())
    }
}

/// Work (J) of blocks at `poses` in `time` (s) against the loads in joints: `all` loads less those of the particles, `own`.
fn joints_work(own: &[Load], all: &[Load], poses: &[Pose], time: f64) -> f64 {
    let each = own.iter().zip(all).zip(poses);
    let moving = each.filter(|((own, all), pose)| {
        own != all && (pose.velocity, pose.deformation_rate) != (DVec3::ZERO, DMat3::ZERO)
    });
    moving
        .map(|((own, all), pose)| {
            let joint = Load {
                force: all.force - own.force,
                moment: all.moment - own.moment,
                ..Load::default()
            };
            -joint.work(pose, &pose.after(time))
        })
        .sum()
}

/// Energies of free water and work on it (Cercos-Pita, Antuono, Colagrossi & Souto-Iglesias 2017, Comput. Methods Appl.
/// Mech. Eng. 317:771), J. Work counts from the start.
///
/// The work of `bodies` on the water is minus the work of the load on them along their motion in the steps of the water.
/// Blocks move after the water, so the work of `blocks` differs; it includes joints.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WaterLedger {
    /// Σ ½mv².
    pub kinetic: f64,
    /// −Σ m g·x, from the origin of the coordinates; x is continuous across periodic boundaries.
    pub potential: f64,
    /// Σ m ∫ p/ρ² dρ.
    pub compression: f64,
    /// Sum of the three energies of the escaped particles, each at the time of its escape.
    pub escaped: f64,
    /// Work of free and driven blocks on the water.
    pub bodies: f64,
    /// Work of the penalty force of fixed bodies on the water.
    pub penalty: f64,
    /// Work of boundary particles on the water beyond the work of their walls and bodies: the error of this boundary
    /// condition, proportional to the spacing. Most of it comes from corners next to moving bodies.
    pub boundary: f64,
    /// Work of blocks in joints that have no particles; it does not reach the water.
    pub joints: f64,
    /// Work of free and driven blocks on the water and in joints along their own motion.
    pub blocks: f64,
}

impl WaterLedger {
    /// Differences from the ledger at the `start`.
    pub fn since(&self, start: &Self) -> Self {
        Self {
            kinetic: self.kinetic - start.kinetic,
            potential: self.potential - start.potential,
            compression: self.compression - start.compression,
            escaped: self.escaped - start.escaped,
            bodies: self.bodies - start.bodies,
            penalty: self.penalty - start.penalty,
            boundary: self.boundary - start.boundary,
            joints: self.joints - start.joints,
            blocks: self.blocks - start.blocks,
        }
    }

    /// Total energy of the water, escaped particles included.
    pub fn total(&self) -> f64 {
        self.kinetic + self.potential + self.compression + self.escaped
    }

    /// Energy dissipated by viscosity and density diffusion, with the error of the time integration, in a ledger
    /// relative to the start ([`WaterLedger::since`]).
    pub fn dissipated(&self) -> f64 {
        self.bodies + self.penalty + self.boundary - self.total()
    }

    /// Work of blocks that the water did not receive, without joints: the error of the staggered exchange.
    pub fn unmatched(&self) -> f64 {
        self.blocks - self.joints - self.bodies
    }
}
