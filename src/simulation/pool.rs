//! Coupling of free water with blocks.

use super::sensors::Sensors;
use crate::{
    Error, Result,
    coupling::{ExchangeInterval, Fluid, FluidLoad, JointSeal, Rock, longest_exchange},
    geometry::{Load, Pose},
    rock::Motion,
    scene::Scene,
    simulation::checkpoint::WaterCheckpoint,
    sph::{Particle, SphSolver, Water},
};
use glam::{DMat3, DVec3};

/// The water of a scene and its exchanges with the blocks.
#[derive(Debug)]
pub(super) struct Pool {
    device: wgpu::Device,
    queue: wgpu::Queue,
    pub particles: SphSolver,
    joint_seal: JointSeal,
    /// Blocks with a load in the last exchange of the step, and all blocks at its start: only their joints can have water.
    wet: Vec<bool>,
    /// Longest time between two exchanges while blocks may move, s.
    longest: f64,
    time: f64,
    average: bool,
    /// Mean loads of the last exchange; empty before the first one.
    pub last: Vec<Load>,
    pub exchanges: u64,
    /// Work of blocks since the start in joints that have no particles, J.
    pub joints: f64,
    /// Steps that sorted the particles.
    pub sorts: u64,
    pub sensors: Sensors,
}

impl Fluid for Pool {
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
        self.exchanges += 1;
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

impl Pool {
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        (scene, rock): (&Scene, &Rock),
        particles: SphSolver,
    ) -> Self {
        let blocks = &rock.setup().setup.blocks;
        let shapes = blocks.iter().map(|block| block.shape.clone()).collect();
        let asked: Vec<bool> = blocks
            .iter()
            .map(|block| block.motion == Motion::Free || scene.probes_block(&block.name))
            .collect();
        let setup = particles.setup();
        let sensors = Sensors::of(scene, setup);
        Self {
            wet: vec![true; setup.bodies.len()],
            device: device.clone(),
            queue: queue.clone(),
            joint_seal: JointSeal::new(shapes, rock.blocks().period(), setup, &asked),
            longest: longest_exchange(rock, setup.density * setup.sound_speed),
            particles,
            time: 0.0,
            average: scene.coupling.average,
            last: Vec::new(),
            exchanges: 0,
            joints: 0.0,
            sorts: 0,
            sensors,
        }
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
            ExchangeInterval::Awake(steps) => {
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

    /// The particles in the units of the device.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn particles(&mut self) -> Result<Vec<Particle>> {
        self.particles.particles(&self.device, &self.queue).await
    }

    /// Checks that a checkpoint fits this water.
    ///
    /// # Errors
    /// If its particles or sensors differ in number.
    pub fn check(&self, checkpoint: &WaterCheckpoint) -> Result<()> {
        let (its, mine) = (checkpoint.sensors.len(), self.sensors.readings.len());
        if its != mine {
            return Err(Error::argument(
                "restart",
                format!(
                    "the checkpoint has {its} pressure sensors and the scene {mine}; restart with the scene that wrote it"
                ),
            ));
        }
        self.particles.check(&checkpoint.particles)
    }

    /// Restores a checkpoint.
    ///
    /// # Errors
    /// If its particles or sensors differ in number.
    pub fn restore(&mut self, checkpoint: &WaterCheckpoint) -> Result<()> {
        self.sensors.readings.clone_from(&checkpoint.sensors);
        self.particles
            .restore(&self.queue, &checkpoint.particles, &checkpoint.state)?;
        self.last.clone_from(&checkpoint.loads);
        self.joints = checkpoint.joints;
        Ok(())
    }
}

/// Work (J) of blocks at `poses` in `time` (s) against the loads beyond their `own`, those in joints.
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
