//! Free water and the blocks in it.

use super::countable::countable;
use super::{BlockSetup, Reading, WaterLedger, block_setup, pool::Pool, scene_step::scene_step};
use crate::{
    Error, Result,
    bodies::Blocks,
    checkpoint::WaterCheckpoint,
    coupling::{self, Company, Felt, Rock},
    error::told,
    particles::{Neighbours, Particles, Totals, Water, particle_setup},
    scene::Scene,
};
use glam::DVec3;

/// A scene of water with a free surface, by particles, and of the blocks in it.
///
/// Nothing here blocks: somebody must poll the device while a future is awaited.
#[derive(Debug)]
pub struct FreeSurface {
    scene: Scene,
    rock: Rock,
    pool: Pool,
    time_step: f64,
    step: u64,
}

impl FreeSurface {
    /// Puts the water of a scene beside its walls and blocks.
    ///
    /// # Errors
    /// What the scene lacks, or what the device cannot hold.
    pub async fn new(device: &wgpu::Device, queue: &wgpu::Queue, scene: &Scene) -> Result<Self> {
        let setup = block_setup(scene)?;
        let (mut water, start) = particle_setup(scene, &setup)?;
        if device.adapter_info().device_type == wgpu::DeviceType::Cpu {
            water.neighbours = Neighbours::Lists;
        }
        let time_step = scene_step(scene, water.acoustic_step());
        let company = Company {
            time_step,
            // Times of exchanges are rounded.
            hold: scene.coupling.hold * (1.0 - 1e-12),
            inside: None,
        };
        let rock = Rock::new(device, queue, scene, setup, company).await?;
        countable(time_step, rock.blocks())?;
        let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let validity = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let particles = Particles::new(
            device,
            queue,
            water,
            &start.positions,
            &start.velocities,
            &start.pressures,
        );
        // What a buffer that is none is bound to is not valid either: memory is the cause.
        let [validity, memory] = [validity.pop(), memory.pop()];
        let refused = (validity.await, memory.await);
        let particles = particles?;
        if let Some(error) = refused.1.or(refused.0) {
            return Err(Error::Device(format!(
                "it does not hold {} particles ({}); use a larger spacing",
                particles.numbers().water,
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
    /// [`Error::ParticleLost`] if the water left the range of the method; those of [`Blocks::advance`], and the blocks then
    /// are where they were at the last exchange; a lost device. A checkpoint leads back to a state from which all can go on.
    pub async fn advance(&mut self, steps: u64) -> Result<()> {
        for _ in 0..steps {
            let end = (self.step + 1) as f64 * self.time_step;
            // Checkpoints are taken between steps.
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

    /// The water as it is.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn water(&mut self) -> Result<Water> {
        self.pool.water().await
    }

    /// What the sensor `name` has felt; none if there is no such probe.
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

    /// The blocks as they were made.
    pub fn setup(&self) -> &BlockSetup {
        self.rock.setup()
    }

    /// The blocks as they are.
    pub fn blocks(&self) -> &Blocks {
        self.rock.blocks()
    }

    /// What each block feels of the water, of the last exchange: all of it as `flow`, buoyancy included.
    pub fn felt(&self) -> &[Felt] {
        self.rock.felt()
    }

    /// Where the energy of `water` is, as it is now, and what was done to it.
    pub fn ledger(&self, water: &Water) -> WaterLedger {
        let particles = &self.pool.particles;
        let totals = Totals::of(particles.setup(), water);
        let works = particles.works();
        WaterLedger {
            kinetic: totals.kinetic_energy,
            potential: totals.potential_energy,
            compression: totals.compression_energy,
            left: water.left.energy(),
            bodies: works.bodies,
            pushed: works.pushed,
            pressed: works.pressed,
            joints: self.pool.joints,
            blocks: self.rock.given,
        }
    }

    /// The particles.
    pub fn particles(&self) -> &Particles {
        &self.pool.particles
    }

    /// How often water and blocks met.
    pub fn exchanges(&self) -> u64 {
        self.pool.exchanges
    }

    /// Steps of the water that sorted its particles, and made lists of neighbours if there are any.
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
            given: self.rock.given,
            sensors: self.pool.sensors.readings.clone(),
            blocks: self.rock.blocks().snapshot(),
        })
    }

    /// Goes on from a checkpoint of the same scene, to the same bits.
    ///
    /// # Errors
    /// If it is of other particles or blocks, or of another time step.
    pub fn restore(&mut self, checkpoint: &WaterCheckpoint) -> Result<()> {
        let domain = &self.scene.domain;
        let spacing = self.pool.particles.setup().spacing;
        let mine = [domain.origin, domain.size].map(DVec3::from);
        let its = [checkpoint.origin, checkpoint.size];
        if its != mine || checkpoint.spacing != spacing {
            return Err(Error::scene(
                "restart",
                format!(
                    "the checkpoint is of a domain from {} m, {} m wide, with particles every {} m, the scene from {} m, \
                     {} m wide, with particles every {spacing} m; restart with the scene that wrote it",
                    its[0], its[1], checkpoint.spacing, mine[0], mine[1]
                ),
            ));
        }
        if checkpoint.time_step != self.time_step {
            return Err(Error::scene(
                "restart",
                format!(
                    "the checkpoint has a time step of {:e} s, the scene {:e} s; restart with the scene that wrote it",
                    checkpoint.time_step, self.time_step
                ),
            ));
        }
        // All is looked at before anything is changed.
        self.pool.check(checkpoint)?;
        self.rock.restore(&checkpoint.blocks)?;
        self.rock.given = checkpoint.given;
        self.pool.restore(checkpoint)?;
        self.step = checkpoint.step;
        Ok(())
    }
}
