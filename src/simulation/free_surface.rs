//! Simulation of free-surface water and blocks.

use super::{Reading, WaterLedger, countable::countable, pool::Pool};
use crate::{
    Error, Result,
    coupling::{self, CouplingParams, FluidLoad, Rock},
    error::told,
    rock::Blocks,
    scene::{
        Scene,
        build::{BlockSetup, block_setup, particle_key, particle_setup, scene_step},
    },
    simulation::checkpoint::WaterCheckpoint,
    sph::{NeighbourSearch, SphSolver, Totals, Water},
};
use glam::DVec3;

/// Simulation of a scene of free-surface water (SPH) and blocks.
///
/// No method blocks: the caller must poll the device while it awaits a future.
#[derive(Debug)]
pub struct FreeSurface {
    scene: Scene,
    rock: Rock,
    pool: Pool,
    time_step: f64,
    step: u64,
}

impl FreeSurface {
    /// The simulation of a scene at its start.
    ///
    /// # Errors
    /// [`Error::Scene`] if the scene is invalid; [`Error::Limit`] or [`Error::Device`] if the device cannot hold it.
    pub async fn new(device: &wgpu::Device, queue: &wgpu::Queue, scene: &Scene) -> Result<Self> {
        let setup = block_setup(scene)?;
        let (mut water, start) = particle_setup(scene, &setup)?;
        if device.adapter_info().device_type == wgpu::DeviceType::Cpu {
            water.neighbours = NeighbourSearch::Lists;
        }
        let time_step = scene_step(scene, water.acoustic_step());
        let params = CouplingParams {
            time_step,
            // The tolerance covers the rounding of exchange times.
            hold: scene.coupling.hold * (1.0 - 1e-12),
            inside: None,
        };
        let rock = Rock::new(device, queue, scene, setup, params).await?;
        countable(time_step, rock.blocks())?;
        let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let validity = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let particles = SphSolver::new(
            device,
            queue,
            water,
            &start.positions,
            &start.velocities,
            &start.pressures,
        );
        // A bind group of a buffer without memory is invalid too, so that the memory error takes precedence.
        let [validity, memory] = [validity.pop(), memory.pop()];
        let refused = (validity.await, memory.await);
        let particles = particles.map_err(|error| error.at_key(particle_key))?;
        if let Some(error) = refused.1.or(refused.0) {
            return Err(Error::Device(format!(
                "it does not hold {} particles ({}); use a larger spacing",
                particles.counts().fluid,
                told(&error)
            )));
        }
        Ok(Self {
            scene: scene.clone(),
            pool: Pool::new(device, queue, (scene, &rock), particles),
            rock,
            time_step,
            step: 0,
        })
    }

    /// Takes `steps` steps.
    ///
    /// # Errors
    /// [`Error::ParticleLost`] if the water left the range of the method; those of [`Blocks::advance`], after which the blocks
    /// are at the last exchange; [`Error::DeviceLost`]. Restore a checkpoint to continue.
    pub async fn advance(&mut self, steps: u64) -> Result<()> {
        for _ in 0..steps {
            let end = (self.step + 1) as f64 * self.time_step;
            // Checkpoints lie between steps.
            self.pool.begin(self.time());
            coupling::run(&mut self.pool, &mut self.rock, end).await?;
            self.step += 1;
        }
        Ok(())
    }

    /// Whether a block can move at all.
    pub fn moves(&self) -> bool {
        self.rock.moves()
    }

    /// The present state of the water.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn water(&mut self) -> Result<Water> {
        self.pool.water().await
    }

    /// Measurement of the sensor `name`; `None` if there is no such probe.
    pub fn sensor(&self, name: &str) -> Option<Reading> {
        self.pool.sensors.reading(name)
    }

    /// Steps done.
    pub fn step(&self) -> u64 {
        self.step
    }

    /// Length of a step, s.
    pub fn time_step(&self) -> f64 {
        self.time_step
    }

    /// Simulated time, s.
    pub fn time(&self) -> f64 {
        self.step as f64 * self.time_step
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The setup of the blocks.
    pub fn setup(&self) -> &BlockSetup {
        self.rock.setup()
    }

    /// The present state of the blocks.
    pub fn blocks(&self) -> &Blocks {
        self.rock.blocks()
    }

    /// Load of the water on each block in the last exchange; `flow` is all of it, buoyancy included.
    pub fn external_load(&self) -> &[FluidLoad] {
        self.rock.external_load()
    }

    /// Energy ledger of `water`, the present state.
    pub fn ledger(&self, water: &Water) -> WaterLedger {
        let particles = &self.pool.particles;
        let totals = Totals::of(particles.setup(), water);
        let work = particles.work();
        WaterLedger {
            kinetic: totals.kinetic_energy,
            potential: totals.potential_energy,
            compression: totals.compression_energy,
            escaped: water.escaped.energy(),
            bodies: work.bodies,
            penalty: work.penalty,
            boundary: work.boundary,
            joints: self.pool.joints,
            blocks: self.rock.work_on_fluid,
        }
    }

    /// The particle solver.
    pub fn particles(&self) -> &SphSolver {
        &self.pool.particles
    }

    /// Exchanges between water and blocks.
    pub fn exchanges(&self) -> u64 {
        self.pool.exchanges
    }

    /// Steps of the water that sorted the particles and rebuilt the neighbour lists, if there are any.
    pub fn sorts(&self) -> u64 {
        self.pool.sorts
    }

    /// The present state, for a later [`FreeSurface::restore`].
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn checkpoint(&mut self) -> Result<WaterCheckpoint> {
        Ok(WaterCheckpoint {
            step: self.step,
            time_step: self.time_step,
            origin: DVec3::from(self.scene.domain.origin),
            size: DVec3::from(self.scene.domain.size),
            spacing: self.pool.particles.setup().spacing,
            particles: self.pool.particles().await?,
            state: self.pool.particles.state(),
            loads: self.pool.last.clone(),
            joints: self.pool.joints,
            given: self.rock.work_on_fluid,
            sensors: self.pool.sensors.readings.clone(),
            blocks: self.rock.blocks().snapshot(),
        })
    }

    /// Restores a checkpoint of the same scene bit-identically.
    ///
    /// # Errors
    /// [`Error::Scene`] if its particles, blocks or time step differ.
    pub fn restore(&mut self, checkpoint: &WaterCheckpoint) -> Result<()> {
        let domain = &self.scene.domain;
        let spacing = self.pool.particles.setup().spacing;
        let own = [domain.origin, domain.size].map(DVec3::from);
        let other = [checkpoint.origin, checkpoint.size];
        if other != own || checkpoint.spacing != spacing {
            return Err(Error::argument(
                "restart",
                format!(
                    "the checkpoint is of a domain from {} m, {} m wide, with particles every {} m, the scene from {} m, \
                     {} m wide, with particles every {spacing} m; restart with the scene that wrote it",
                    other[0], other[1], checkpoint.spacing, own[0], own[1]
                ),
            ));
        }
        if checkpoint.time_step != self.time_step {
            return Err(Error::argument(
                "restart",
                format!(
                    "the checkpoint has a time step of {:e} s, the scene {:e} s; restart with the scene that wrote it",
                    checkpoint.time_step, self.time_step
                ),
            ));
        }
        // All checks come before the first change.
        self.pool.check(checkpoint)?;
        self.rock.restore(&checkpoint.blocks)?;
        self.rock.work_on_fluid = checkpoint.given;
        self.pool.restore(checkpoint)?;
        self.step = checkpoint.step;
        Ok(())
    }
}
