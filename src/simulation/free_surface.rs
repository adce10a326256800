//! Free water and the blocks in it.

use super::{BlockSetup, begin, block_setup, finder};
use crate::{
    Error, Result,
    bodies::{Blocks, Load, Motion, Pose, Snapshot},
    broadphase::AutoBroadphase,
    checkpoint::WaterCheckpoint,
    coupling::Felt,
    particles::{Neighbours, Particles, Water, particle_setup},
    scene::Scene,
};

/// Acoustic steps of a step of the scene: the water takes as many as it wants, and an unequal last one wastes at
/// most a tenth.
const ACOUSTIC_STEPS: f64 = 10.0;

/// A scene of water with a free surface, by particles, and of the blocks in it.
///
/// Nothing here blocks: somebody must poll the device while a future is awaited.
#[derive(Debug)]
pub struct FreeSurface {
    device: wgpu::Device,
    queue: wgpu::Queue,
    scene: Scene,
    setup: BlockSetup,
    blocks: Blocks,
    finder: AutoBroadphase,
    particles: Particles,
    time_step: f64,
    step: u64,
    exchanges: u64,
    sorts: u64,
    /// Mean loads of the last exchange, none before the first one.
    last: Vec<Load>,
    felt: Vec<Felt>,
    /// What blocks go back to if a step of theirs fails; its memory is used again.
    good: Snapshot,
}

impl FreeSurface {
    /// Puts the water of a scene beside its walls and blocks.
    ///
    /// # Errors
    /// What the scene lacks, or what the device cannot hold.
    pub async fn new(device: &wgpu::Device, queue: &wgpu::Queue, scene: &Scene) -> Result<Self> {
        let mut setup = block_setup(scene)?;
        let (mut water, start) = particle_setup(scene, &setup)?;
        if device.adapter_info().device_type == wgpu::DeviceType::Cpu {
            water.neighbours = Neighbours::Lists;
        }
        let usual = ACOUSTIC_STEPS * water.acoustic_step();
        let time_step = match scene.run.duration {
            // A whole number of steps, so that the run ends when it is said to.
            Some(duration) => duration / (duration / usual).ceil().max(1.0),
            None => usual,
        };
        let mut blocks = setup.setup.blocks.iter();
        if setup.setup.time_step.is_none() && !blocks.any(|block| block.motion == Motion::Free) {
            // No contact limits the step of blocks that nothing pushes.
            setup.setup.time_step = Some(time_step);
        }
        let mut finder = finder(device, queue, scene.rock.search);
        let blocks = begin(scene, &setup, &mut finder).await?;
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
        let refused = validity.pop().await.or(memory.pop().await);
        let particles = particles?;
        if let Some(error) = refused {
            return Err(Error::Device(format!(
                "it does not hold {} particles ({error}); use a larger spacing",
                particles.numbers().water
            )));
        }
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            scene: scene.clone(),
            time_step,
            step: 0,
            exchanges: 0,
            sorts: 0,
            last: Vec::new(),
            felt: vec![Felt::default(); blocks.len()],
            good: Snapshot::default(),
            setup,
            blocks,
            finder,
            particles,
        })
    }

    /// Takes `steps` steps.
    ///
    /// # Errors
    /// [`Error::ParticleLost`] if the water left the range of the method; those of [`Blocks::advance`], and the blocks then
    /// are where they were at the last exchange; a lost device. A checkpoint leads back to a state from which all can go on.
    pub async fn advance(&mut self, steps: u64) -> Result<()> {
        for _ in 0..steps {
            let (from, end) = (self.time(), (self.step + 1) as f64 * self.time_step);
            let mut time = from;
            // Checkpoints are taken between steps.
            self.particles.renew();
            while time < end {
                let until = self.next(time, end);
                self.exchange(time, until).await?;
                time = until;
            }
            self.step += 1;
        }
        Ok(())
    }

    /// When water and blocks meet next: after as many steps of the water as the scene says; nothing to meet
    /// before the end if nothing moves.
    fn next(&self, time: f64, end: f64) -> f64 {
        if !self.moves() {
            return end;
        }
        let interval = f64::from(self.scene.coupling.interval) * self.particles.limit();
        let parts = ((end - time) / interval * (1.0 - 1e-6)).ceil().max(1.0);
        if parts == 1.0 {
            end
        } else {
            time + (end - time) / parts
        }
    }

    /// The water runs until the time `until` (s) beside blocks that move on as they do, and these then under what
    /// it did to them.
    async fn exchange(&mut self, time: f64, until: f64) -> Result<()> {
        let poses = self.poses();
        let (device, queue) = (&self.device, &self.queue);
        let done = self
            .particles
            .advance(device, queue, &poses, until - time)
            .await?;
        self.exchanges += 1;
        self.sorts += u64::from(done.sorts);
        if !self.scene.coupling.average || self.last.is_empty() {
            self.last.clone_from(&done.loads);
        }
        for ((felt, last), new) in self.felt.iter_mut().zip(&mut self.last).zip(&done.loads) {
            felt.flow = Load {
                force: 0.5 * (last.force + new.force),
                moment: 0.5 * (last.moment + new.moment),
                ..Load::default()
            };
            *last = *new;
        }
        if !self.moves() {
            return Ok(());
        }
        if until < self.scene.coupling.hold * (1.0 - 1e-12) {
            self.blocks.wait(until);
            return Ok(());
        }
        self.blocks.save(&mut self.good);
        let loads: Vec<Load> = self.felt.iter().map(|felt| felt.flow).collect();
        let moved = match self.blocks.load(&loads) {
            Ok(()) => self.blocks.advance(&mut self.finder, until).await,
            refused => refused,
        };
        if moved.is_err() {
            self.blocks.restore(&self.good)?;
        }
        moved
    }

    /// Where the blocks are and how they move: not at all while they are held.
    fn poses(&self) -> Vec<Pose> {
        let mut poses = self.blocks.poses();
        if self.blocks.time() < self.scene.coupling.hold * (1.0 - 1e-12) {
            for pose in &mut poses {
                pose.velocity = glam::DVec3::ZERO;
                pose.deformation_rate = glam::DMat3::ZERO;
            }
        }
        poses
    }

    /// Whether a block can move at all.
    pub fn moves(&self) -> bool {
        (0..self.blocks.len()).any(|block| self.blocks.moves(block))
    }

    /// The water as it is.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn water(&mut self) -> Result<Water> {
        self.particles.water(&self.device, &self.queue).await
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
        &self.setup
    }

    /// The blocks as they are.
    pub fn blocks(&self) -> &Blocks {
        &self.blocks
    }

    /// What each block feels of the water, of the last exchange: all of it as `flow`, buoyancy included.
    pub fn felt(&self) -> &[Felt] {
        &self.felt
    }

    /// The particles.
    pub fn particles(&self) -> &Particles {
        &self.particles
    }

    /// How often water and blocks met.
    pub fn exchanges(&self) -> u64 {
        self.exchanges
    }

    /// Steps of the water that sorted its particles, and made lists of neighbours if there are any.
    pub fn sorts(&self) -> u64 {
        self.sorts
    }

    /// The present state, for a later [`FreeSurface::restore`].
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn checkpoint(&mut self) -> Result<WaterCheckpoint> {
        Ok(WaterCheckpoint {
            step: self.step,
            time_step: self.time_step,
            particles: self.particles.particles(&self.device, &self.queue).await?,
            state: self.particles.state(),
            loads: self.last.clone(),
            blocks: self.blocks.snapshot(),
        })
    }

    /// Goes on from a checkpoint of the same scene, to the same bits.
    ///
    /// # Errors
    /// If it is of other particles or blocks, or of another time step.
    pub fn restore(&mut self, checkpoint: &WaterCheckpoint) -> Result<()> {
        if checkpoint.time_step != self.time_step {
            return Err(Error::scene(
                "restart",
                format!(
                    "the checkpoint has a time step of {:e} s, the scene {:e} s; restart with the scene that wrote it",
                    checkpoint.time_step, self.time_step
                ),
            ));
        }
        let within = |error: Error| Error::scene("restart", error.to_string());
        // All is looked at before anything is changed.
        self.particles.check(&checkpoint.particles)?;
        self.blocks.restore(&checkpoint.blocks).map_err(within)?;
        self.particles
            .restore(&self.queue, &checkpoint.particles, &checkpoint.state)?;
        self.last.clone_from(&checkpoint.loads);
        self.step = checkpoint.step;
        Ok(())
    }
}
