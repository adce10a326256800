//! The blocks of a scene in its lattice.

use super::{Ambient, Follower, Gap, Reading, gaps::gaps, loads::sum};
use crate::{
    Result,
    bodies::{Block, Blocks, Load, Motion, Pose},
    broadphase::AutoBroadphase,
    immersed::{Frame, Immersed, Submerged, Work},
    lattice::Lattice,
    scene::{ProbePlace, Scene, Search},
    simulation::{self, BlockSetup},
    units::Units,
};
use glam::{DMat3, DVec3};

/// Exchanges that are left out between two looks at the loads while every block rests.
const REST: u64 = 16;

/// How often fluid and blocks met since the start or the last restart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exchanges {
    /// Loads read back: those of the steps after which blocks moved, and of the steps before these.
    pub readings: u64,
    /// What was computed of the blocks' cells.
    pub cells: Work,
}

/// What a block feels of the fluid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Felt {
    /// What the flow does: zero at rest. Without buoyancy.
    pub flow: Load,
    /// Buoyancy, −ρ g Σε.
    pub buoyancy: Load,
}

/// Blocks in a fluid.
#[derive(Debug)]
pub struct Coupled {
    setup: BlockSetup,
    pub(super) blocks: Blocks,
    finder: AutoBroadphase,
    immersed: Immersed,
    /// Of the last two steps.
    readings: [Reading; 2],
    ambient: Ambient,
    /// Blocks in the fluid, the first ones; the others are walls and solids, which the lattice has already.
    in_fluid: usize,
    /// Those narrower than a cell at the start.
    gaps: Vec<Gap>,
    interval: u64,
    average: bool,
    /// Steps for which the blocks are held.
    hold: u64,
    /// What the fluid did to the blocks in the last step that was read.
    pub(super) last: Vec<Load>,
    pub(super) felt: Vec<Felt>,
    pub(super) followers: Vec<Follower>,
    /// Whether loads have been read, so that `last` is of the step before.
    pub(super) begun: bool,
    read: u64,
    /// Whether the cells have been computed for the present poses.
    pub(super) placed: bool,
}

impl Coupled {
    /// The blocks of a scene, as `setup` has them, in its lattice.
    ///
    /// # Errors
    /// What the blocks or the device lack.
    pub async fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lattice: &Lattice,
        (scene, units): (&Scene, &Units),
        setup: BlockSetup,
    ) -> Result<Self> {
        let mut finder = AutoBroadphase::new(device, queue);
        match scene.rock.search {
            Search::Auto => {}
            Search::Host => finder.crossover = usize::MAX,
            Search::Device => finder.crossover = 0,
        }
        let mut setup = setup;
        let free = |block: &Block| block.motion == Motion::Free;
        if setup.setup.time_step.is_none() && !setup.setup.blocks.iter().any(free) {
            // No contact limits the step of blocks that nothing pushes.
            setup.setup.time_step = Some(units.time_step);
        }
        let blocks = simulation::begin(scene, &setup, &mut finder).await?;
        let asked = |name: &str| {
            let of =
                |place: &ProbePlace| matches!(place, ProbePlace::Block { block } if block == name);
            scene.probes.iter().any(|probe| of(&probe.place))
        };
        let in_fluid = setup.in_fluid;
        let gaps = gaps(&setup.setup, &blocks, in_fluid, units.cell, &mut finder).await?;
        let submerged = setup.setup.blocks[..in_fluid]
            .iter()
            .map(|block| Submerged {
                shape: block.shape.clone(),
                loaded: block.motion != Motion::Fixed || asked(&block.name),
            });
        let frame = Frame {
            origin: DVec3::from(scene.domain.origin),
            units: *units,
        };
        Ok(Self {
            immersed: Immersed::new(device, lattice, frame, submerged.collect())?,
            readings: [Reading::default(), Reading::default()],
            ambient: Ambient {
                density: scene.fluid.density,
                acceleration: scene.fluid.acceleration.clone(),
                gravity: DVec3::from(scene.rock.gravity),
            },
            in_fluid,
            gaps,
            interval: scene.coupling.interval.into(),
            average: scene.coupling.average,
            hold: (scene.coupling.hold / units.time_step).round() as u64,
            last: vec![Load::default(); in_fluid],
            felt: vec![Felt::default(); setup.setup.blocks.len()],
            followers: vec![Follower::default(); setup.setup.blocks.len()],
            begun: false,
            read: 0,
            placed: false,
            setup,
            blocks,
            finder,
        })
    }

    /// Puts the blocks where they are and records their cells, unless that is done.
    ///
    /// # Errors
    /// If the device does not hold the cells.
    pub fn place(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lattice: &mut Lattice,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<()> {
        if !self.placed {
            let poses = self.blocks.poses();
            self.immersed
                .place(device, queue, lattice, &poses[..self.in_fluid])?;
            let mut pass = encoder.begin_compute_pass(&Default::default());
            self.immersed.record_cells(&mut pass);
            drop(pass);
            self.placed = true;
        }
        Ok(())
    }

    /// Whether fluid and blocks meet at the end of the step `step`, counted from 1, of those until `last`.
    pub fn meets(&self, step: u64, last: u64) -> bool {
        let interval = match (self.moves(), self.rests()) {
            // The loads change nothing; those who ask about them look after the last step.
            (false, _) => return step == last && self.immersed.wrench_count() > 0,
            (true, false) => self.interval,
            (true, true) => self.interval * REST,
        };
        step.is_multiple_of(interval)
    }

    /// Whether the loads of the step `step`, counted from 1, are wanted beside those of the next one, for
    /// their mean.
    pub fn prepares(&self, step: u64, last: u64) -> bool {
        self.average && !self.meets(step, last) && self.meets(step + 1, last)
    }

    /// Whether a block can move at all.
    pub fn moves(&self) -> bool {
        (0..self.blocks.len()).any(|block| self.blocks.moves(block))
    }

    /// Whether all that can move sleeps.
    fn rests(&self) -> bool {
        let mut all = self.blocks.asleep().enumerate();
        all.all(|(block, asleep)| asleep || !self.blocks.moves(block))
    }

    /// Records the sums of what the fluid did to the blocks in this step, and their way to the host;
    /// `early` for the step before that of [`Coupled::read_loads`].
    pub fn record_loads(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        early: bool,
    ) {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        self.immersed.record_loads(&mut pass);
        drop(pass);
        let (buffer, count) = (self.immersed.wrenches(), self.immersed.wrench_count());
        self.readings[usize::from(early)].record(device, encoder, buffer, count);
    }

    /// Waits for the loads that were recorded and takes them over.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn read_loads(&mut self) -> Result<()> {
        let [last, early] = &mut self.readings;
        if early.is_pending() {
            self.last = self.immersed.loads(&early.finish().await?)?;
            self.begun = true;
            self.read += 1;
        }
        let loads = self.immersed.loads(&last.finish().await?)?;
        let poses = self.blocks.poses();
        for (block, load) in loads.iter().enumerate() {
            let single = !self.begun || !self.average;
            let load = if single {
                *load
            } else {
                mean(load, &self.last[block])
            };
            self.felt[block] = Felt {
                flow: sum(load, self.ambient.push(&load, poses[block].centre)),
                buoyancy: self.ambient.buoyancy(&load),
            };
        }
        self.last = loads;
        self.begun = true;
        self.read += 1;
        Ok(())
    }

    /// Moves the blocks under the loads of the last reading until the time `until` (s).
    ///
    /// # Errors
    /// Those of [`Blocks::advance`].
    pub async fn advance(&mut self, until: f64) -> Result<()> {
        let dt = self.immersed.frame().units.time_step;
        if until < (self.hold as f64 + 0.5) * dt {
            self.blocks.wait(until);
            return Ok(());
        }
        let dt = until - self.blocks.time();
        let poses = self.blocks.poses();
        for ((block, follower), pose) in self.followers.iter_mut().enumerate().zip(&poses) {
            if self.blocks.moves(block) {
                follower.follow(pose, dt);
            }
        }
        let loads: Vec<Load> = (0..self.blocks.len())
            .map(|block| self.load(block, &poses[block]))
            .collect();
        self.blocks.load(&loads)?;
        self.blocks.advance(&mut self.finder, until).await?;
        self.placed = false;
        Ok(())
    }

    /// The whole load on a block.
    fn load(&self, block: usize, pose: &Pose) -> Load {
        let felt = &self.felt[block];
        let all = sum(felt.flow, felt.buoyancy);
        if felt.flow.entrained == 0.0 {
            return all;
        }
        let shape = &self.setup.setup.blocks[block].shape;
        let turn: DMat3 = pose.deformation;
        let inertia = turn * shape.inertia() * turn.transpose();
        let density = self.ambient.density;
        let follower = &self.followers[block];
        sum(
            all,
            follower.load(density, &felt.flow, inertia, shape.volume()),
        )
    }

    /// What each block feels of the fluid, of the last reading.
    pub fn felt(&self) -> &[Felt] {
        &self.felt
    }

    /// The blocks as they are.
    pub fn blocks(&self) -> &Blocks {
        &self.blocks
    }

    /// The blocks as they were made.
    pub fn setup(&self) -> &BlockSetup {
        &self.setup
    }

    /// Number of blocks that are in the fluid, the first ones; the others are its solids and walls.
    pub fn in_fluid(&self) -> usize {
        self.in_fluid
    }

    /// The pairs of blocks, one of them in the fluid, that were less than a cell apart at the start.
    pub fn gaps(&self) -> &[Gap] {
        &self.gaps
    }

    /// Their cells.
    pub fn immersed(&self) -> &Immersed {
        &self.immersed
    }

    /// How often fluid and blocks met.
    pub fn exchanges(&self) -> Exchanges {
        Exchanges {
            readings: self.read,
            cells: self.immersed.work(),
        }
    }
}

/// The mean of two loads (Owen, Leonardi & Feng 2011); volumes are those of the first.
fn mean(a: &Load, b: &Load) -> Load {
    Load {
        force: 0.5 * (a.force + b.force),
        moment: 0.5 * (a.moment + b.moment),
        ..*a
    }
}
