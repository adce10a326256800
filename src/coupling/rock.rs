//! The blocks of a scene beside its fluid, whichever that is.

use super::{Around, InnerFluid, Matter, Pace, loads::sum};
use crate::{
    Result,
    block::Shape,
    bodies::{Block, Blocks, Load, Motion, Pose, Snapshot, skew},
    broadphase::AutoBroadphase,
    scene::Scene,
    simulation::{self, BlockSetup},
};
use glam::{DMat3, DVec3};
use std::sync::Arc;

/// Exchanges that are left out between two looks at the loads while every block rests.
const REST: u64 = 16;
/// Share of its weight by which the load on a sleeping block may change and leave it asleep: far above the rounding
/// of sums over cells and the last swirls in still water, far below what moves a block.
const STIR: f64 = 1e-3;

/// What a block feels of the fluid, the mean since the exchange before.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Felt {
    /// What the flow does: zero at rest where buoyancy is apart.
    pub flow: Load,
    /// Buoyancy, −ρ g Σε, of a fluid whose pressure is counted from the hydrostatic one.
    pub buoyancy: Load,
}

/// What blocks want to know of their fluid.
#[derive(Clone, Copy, Debug)]
pub struct Company {
    /// Length of its steps, s: that of blocks that nothing pushes.
    pub time_step: f64,
    /// Blocks are held in all exchanges that begin before this time, s.
    pub hold: f64,
    /// The fluid that is inside the blocks too; none where they displace it.
    pub inside: Option<Inside>,
}

/// A fluid that is inside of blocks too.
#[derive(Clone, Copy, Debug)]
pub struct Inside {
    /// Density, kg/m³.
    pub density: f64,
    /// Thickness of the layer that goes along with a block between two exchanges, m: that of a cell.
    pub layer: f64,
}

/// Blocks that feel a fluid.
#[derive(Debug)]
pub struct Rock {
    pub(super) setup: BlockSetup,
    pub(super) blocks: Blocks,
    pub(super) finder: AutoBroadphase,
    interval: u64,
    hold: f64,
    inside: Option<Inside>,
    /// What the fluid around each block is to it at most.
    bounds: Vec<Around>,
    pub(super) felt: Vec<Felt>,
    around: Vec<Felt>,
    pub(super) inner: Vec<InnerFluid>,
    /// What blocks go back to if a step of theirs fails; its memory is used again.
    good: (Snapshot, Vec<InnerFluid>),
    met: u64,
    /// What blocks, free and driven, have given up to the fluid since the start, J.
    pub(crate) given: f64,
}

impl Rock {
    /// The blocks of a scene, as `setup` has them.
    ///
    /// # Errors
    /// What the blocks lack.
    pub async fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        setup: BlockSetup,
        company: Company,
    ) -> Result<Self> {
        let mut setup = setup;
        let free = |block: &Block| block.motion == Motion::Free;
        if setup.setup.time_step.is_none() && !setup.setup.blocks.iter().any(free) {
            // No contact limits the step of blocks that nothing pushes.
            setup.setup.time_step = Some(company.time_step);
        }
        let mut finder = simulation::finder(device, queue, scene.rock.search);
        let blocks = simulation::begin(scene, &setup, &mut finder).await?;
        Ok(Self {
            interval: scene.coupling.interval.into(),
            hold: company.hold,
            inside: company.inside,
            bounds: company.inside.map_or_else(Vec::new, |inside| {
                let shapes = setup.setup.blocks.iter().map(|block| &block.shape);
                let around =
                    |shape: &Arc<Shape>| Around::of(shape.volume(), shape.inertia(), inside.layer);
                shapes.map(around).collect()
            }),
            felt: vec![Felt::default(); blocks.len()],
            around: vec![Felt::default(); blocks.len()],
            inner: vec![InnerFluid::default(); blocks.len()],
            good: (Snapshot::default(), Vec::new()),
            met: 0,
            given: 0.0,
            setup,
            blocks,
            finder,
        })
    }

    /// Where the blocks are and how they move: not at all while they are held.
    pub fn poses(&self) -> Vec<Pose> {
        let mut poses = self.blocks.poses();
        if self.is_held() {
            for pose in &mut poses {
                (pose.velocity, pose.deformation_rate) = (DVec3::ZERO, DMat3::ZERO);
            }
        }
        poses
    }

    /// Whether they are held in an exchange that begins now.
    fn is_held(&self) -> bool {
        self.blocks.time() < self.hold
    }

    /// Whether a block can move at all.
    pub fn moves(&self) -> bool {
        (0..self.blocks.len()).any(|block| self.blocks.moves(block))
    }

    /// How often they want to meet the fluid now.
    pub fn pace(&self) -> Pace {
        if !self.moves() {
            return Pace::Still;
        }
        let mut all = self.blocks.asleep().enumerate();
        match all.all(|(block, asleep)| asleep || !self.blocks.moves(block)) {
            true => Pace::Asleep(self.interval * REST),
            false => Pace::Awake(self.interval),
        }
    }

    /// Fluid and blocks meet at the time `until` (s): these move on under what they felt since the last time.
    ///
    /// # Errors
    /// Those of [`Blocks::advance`]. The blocks then are where they were.
    pub async fn meet(&mut self, felt: &[Felt], until: f64) -> Result<()> {
        self.met += 1;
        for (old, new) in self.felt.iter_mut().zip(felt) {
            *old = *new;
        }
        if !self.moves() || self.is_held() {
            self.around.clone_from(&self.felt);
            if self.moves() {
                self.blocks.wait(until)?;
            }
            return Ok(());
        }
        let dt = until - self.blocks.time();
        self.blocks.save(&mut self.good.0);
        self.good.1.clone_from(&self.inner);
        let poses = self.blocks.poses();
        let mut loads: Vec<Load> = (0..poses.len())
            .map(|block| self.load(block, &poses[block], dt))
            .collect();
        self.calm(&mut loads);
        let moved = match self.blocks.load(&loads) {
            Ok(()) => self.blocks.advance(&mut self.finder, until).await,
            refused => refused,
        };
        if moved.is_err() {
            self.inner.clone_from(&self.good.1);
            self.blocks.restore(&self.good.0)?;
        } else {
            let ways = poses.iter().zip(self.blocks.poses());
            let work = |(load, (from, to)): (&Load, (&Pose, Pose))| load.work(from, &to);
            self.given -= loads.iter().zip(ways).map(work).sum::<f64>();
            self.look_around();
        }
        moved
    }

    /// Leaves sleeping blocks the loads that they have, unless theirs have changed so much that it matters.
    fn calm(&self, loads: &mut [Load]) {
        let asleep = self.blocks.asleep().zip(self.blocks.loads());
        for (block, (load, (asleep, [force, torque]))) in loads.iter_mut().zip(asleep).enumerate() {
            let weight = self.blocks.mass(block) * self.blocks.gravity().length();
            let scale = STIR * if weight > 0.0 { weight } else { force.length() };
            let radius = self.setup.setup.blocks[block].shape.radius();
            if asleep
                && (load.force - force).length() <= scale
                && (load.torque() - torque).length() <= scale * radius
            {
                (load.force, load.moment) = (force, 0.5 * skew(torque));
            }
        }
    }

    /// The whole load on a block, from the fluid around it and any inside it, over the last `dt` (s).
    fn load(&mut self, block: usize, pose: &Pose, dt: f64) -> Load {
        let felt = &self.felt[block];
        let made = &self.setup.setup.blocks[block];
        let Some(Inside { density, .. }) = self.inside else {
            return sum(felt.flow, felt.buoyancy);
        };
        if made.motion != Motion::Free {
            self.inner[block].follow(pose, dt);
            return sum(felt.flow, felt.buoyancy);
        }
        let matter = Matter {
            mass: self.blocks.mass(block),
            volume: made.shape.volume(),
            inertia: turned(pose, made.shape.inertia()),
            gravity: self.blocks.gravity(),
            around: self.bounds[block],
        };
        self.inner[block].load(felt, pose, &matter, density, dt)
    }

    /// Tells what the fluid outside does from what moved the blocks.
    pub(super) fn look_around(&mut self) {
        let held = self.is_held();
        let (loads, poses): (Vec<_>, _) = (self.blocks.loads().collect(), self.blocks.poses());
        self.around.clone_from(&self.felt);
        let Some(Inside { density, .. }) = self.inside.filter(|_| !held) else {
            return;
        };
        for (block, felt) in self.around.iter_mut().enumerate() {
            let (made, inner) = (&self.setup.setup.blocks[block], &self.inner[block]);
            match &made.motion {
                Motion::Free if inner.knows() => {
                    let [force, torque] = loads[block];
                    let turn = torque - felt.buoyancy.torque() - felt.flow.torque();
                    felt.flow.force = force - felt.buoyancy.force;
                    felt.flow.moment += 0.5 * skew(turn);
                }
                Motion::Driven { .. } => {
                    let shape = &made.shape;
                    let inertia = turned(&poses[block], shape.inertia());
                    felt.flow = inner.around(felt, inertia, shape.volume(), density);
                }
                _ => {}
            }
        }
    }

    /// What the fluid around each block does to it, of the last exchange: what moves it beside its weight and its contacts,
    /// without the inertia of the fluid inside its cells, which [`Rock::felt`] has.
    pub fn around(&self) -> &[Felt] {
        &self.around
    }

    /// What each block feels of the fluid, of the last exchange: what its cells take up, the inertia of the fluid inside
    /// them included.
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

    /// How often fluid and blocks met, or were asked for.
    pub fn meetings(&self) -> u64 {
        self.met
    }

    /// Goes back, or on, to a state of the same blocks.
    ///
    /// # Errors
    /// [`crate::Error::Scene`] if it is of other blocks.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Result<()> {
        self.blocks
            .restore(snapshot)
            .map_err(|error| crate::Error::scene("restart", error.to_string()))
    }
}

/// A tensor of inertia as a body was made, as it lies.
fn turned(pose: &Pose, inertia: DMat3) -> DMat3 {
    pose.deformation * inertia * pose.deformation.transpose()
}
