//! The blocks of a scene in its lattice.

use super::{
    Ambient, Gap, Gathered, InnerFluid, Matter, Reading, faces::asked, gaps::gaps, inlets::AtInlet,
    loads::sum,
};
use crate::{
    Error, Result,
    bodies::{Block, Blocks, Load, Motion, Pose, Snapshot, skew},
    broadphase::AutoBroadphase,
    coupling::film::film,
    immersed::{FaceLoad, Frame, Immersed, Submerged, Work},
    lattice::Lattice,
    scene::Scene,
    simulation::{self, BlockSetup},
    units::Units,
};
use glam::{DMat3, DVec3};

/// Exchanges that are left out between two looks at the loads while every block rests.
const REST: u64 = 16;
/// Share of its weight by which the load on a sleeping block may change and leave it asleep: far above the rounding
/// of sums over cells and the last swirls in still water, far below what moves a block.
const STIR: f64 = 1e-3;

/// How often fluid and blocks met since the start or the last restart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exchanges {
    /// Times that the host waited for loads: at the ends of steps after which blocks moved, or were asked for.
    pub readings: u64,
    /// What was computed of the blocks' cells.
    pub cells: Work,
}

/// What a block feels of the fluid, the mean since the exchange before.
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
    pub(super) immersed: Immersed,
    pub(super) reading: Reading,
    pub(super) face_reading: Reading,
    /// Of the blocks in the fluid; empty before the first exchange.
    pub(super) faces: Vec<Vec<FaceLoad>>,
    pub(super) ambient: Ambient,
    /// Blocks in the fluid, the first ones; the others are walls and solids, which the lattice has already.
    in_fluid: usize,
    /// Those narrower than a cell at the start.
    gaps: Vec<Gap>,
    /// Blocks that lie where fluid enters at the start.
    pub(super) began: Vec<AtInlet>,
    interval: u64,
    average: bool,
    /// Steps for which the blocks are held.
    hold: u64,
    pub(super) gathered: Gathered,
    pub(super) felt: Vec<Felt>,
    pub(super) inner: Vec<InnerFluid>,
    /// What blocks go back to if a step of theirs fails; its memory is used again.
    good: (Snapshot, Vec<InnerFluid>),
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
        let mut finder = simulation::finder(device, queue, scene.rock.search);
        let mut setup = setup;
        let free = |block: &Block| block.motion == Motion::Free;
        if setup.setup.time_step.is_none() && !setup.setup.blocks.iter().any(free) {
            // No contact limits the step of blocks that nothing pushes.
            setup.setup.time_step = Some(units.time_step);
        }
        setup.setup.film = film(scene, units, &setup.setup.blocks);
        let blocks = simulation::begin(scene, &setup, &mut finder).await?;
        let in_fluid = setup.in_fluid;
        let gaps = gaps(&setup.setup, &blocks, in_fluid, units.cell, &mut finder).await?;
        let submerged = setup.setup.blocks[..in_fluid].iter().map(|block| {
            let [followed, faces] = asked(scene, &block.name);
            Submerged {
                shape: block.shape.clone(),
                loaded: block.motion != Motion::Fixed || followed,
                faces,
            }
        });
        let frame = Frame {
            origin: DVec3::from(scene.domain.origin),
            units: *units,
        };
        let mut coupled = Self {
            immersed: Immersed::new(device, lattice, frame, submerged.collect())?,
            reading: Reading::default(),
            face_reading: Reading::default(),
            faces: Vec::new(),
            ambient: Ambient {
                density: scene.fluid.density,
                acceleration: scene.fluid.acceleration.clone(),
                gravity: DVec3::from(scene.rock.gravity),
            },
            in_fluid,
            gaps,
            began: Vec::new(),
            interval: scene.coupling.interval.into(),
            average: scene.coupling.average,
            hold: (scene.coupling.hold / units.time_step).round() as u64,
            gathered: Gathered::default(),
            felt: vec![Felt::default(); setup.setup.blocks.len()],
            inner: vec![InnerFluid::default(); setup.setup.blocks.len()],
            good: (Snapshot::default(), Vec::new()),
            read: 0,
            placed: false,
            setup,
            blocks,
            finder,
        };
        coupled.began = coupled.will_be_at_inlets(scene, units);
        Ok(coupled)
    }

    /// Puts the blocks where they are and records their cells, unless that is done.
    ///
    /// # Errors
    /// If the device does not hold the cells: [`Error::Device`] where its memory ends, after which the simulation is
    /// to be made anew.
    pub async fn place(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lattice: &mut Lattice,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<()> {
        if self.placed {
            return Ok(());
        }
        let poses = self.poses();
        // What a buffer that is none is bound to is not valid either.
        let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let validity = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let placed = self
            .immersed
            .place(device, queue, lattice, &poses[..self.in_fluid]);
        let [validity, memory] = [validity.pop(), memory.pop()];
        let refused = validity.await.or(memory.await);
        placed?;
        if let Some(error) = refused {
            return Err(Error::Device(format!(
                "it does not hold the cells of {} blocks in the fluid ({error}); use fewer or smaller ones, or a \
                 larger cell",
                self.in_fluid
            )));
        }
        let mut pass = encoder.begin_compute_pass(&Default::default());
        self.immersed.record_cells(&mut pass);
        drop(pass);
        self.placed = true;
        Ok(())
    }

    /// Where the blocks are and how they move: not at all while they are held.
    pub(super) fn poses(&self) -> Vec<Pose> {
        let mut poses = self.blocks.poses();
        if self.holds(self.blocks.time() + self.time_step()) {
            for pose in &mut poses {
                (pose.velocity, pose.deformation_rate) = (DVec3::ZERO, DMat3::ZERO);
            }
        }
        poses
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

    /// Whether the loads of the step `step`, counted from 1, are wanted: of all steps while a block moves, else
    /// for their mean also of the step before fluid and blocks meet.
    pub fn wants(&self, step: u64, last: u64) -> bool {
        self.moves() && !self.rests()
            || self.meets(step, last)
            || self.average && self.meets(step + 1, last)
    }

    /// Length of a step of the fluid, s.
    fn time_step(&self) -> f64 {
        self.immersed.frame().units.time_step
    }

    /// Whether the blocks are held until the time `until` (s).
    fn holds(&self, until: f64) -> bool {
        until < (self.hold as f64 + 0.5) * self.time_step()
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

    /// Records the sums of what the fluid did to the blocks in the step `step`, and their way to the host.
    pub fn record_loads(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        step: u64,
    ) {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        self.immersed.record_loads(&mut pass);
        drop(pass);
        let sums = (self.immersed.wrenches(), self.immersed.wrench_count());
        self.reading.record(device, encoder, sums, step);
    }

    /// Waits for the loads that were recorded and adds them to those since the last exchange.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn read_loads(&mut self) -> Result<()> {
        for (step, sums) in self.reading.finish().await? {
            let poses = self.blocks.poses();
            let flow =
                |(load, pose): (Load, &Pose)| sum(load, self.ambient.push(&load, pose.centre));
            let loads = self.immersed.loads(&sums)?.into_iter().zip(&poses);
            self.gathered
                .add(step, loads.map(flow).collect(), self.average);
        }
        self.read_faces().await
    }

    /// Ends the time since the last exchange: the blocks feel the mean of its loads.
    pub fn exchange(&mut self) {
        self.read += 1;
        let flows = self.gathered.take().unwrap_or_default();
        for (felt, flow) in self.felt.iter_mut().zip(flows) {
            let buoyancy = self.ambient.buoyancy(&flow);
            *felt = Felt { flow, buoyancy };
        }
    }

    /// Moves the blocks under what they feel until the time `until` (s).
    ///
    /// # Errors
    /// Those of [`Blocks::advance`]. The blocks then are where they were.
    pub async fn advance(&mut self, until: f64) -> Result<()> {
        if self.holds(until) {
            self.blocks.wait(until);
            // The last of it lets the fluid know how they move.
            self.placed = self.holds(until + self.time_step());
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
        }
        self.placed = false;
        moved
    }

    /// Leaves sleeping blocks the loads that they have, unless theirs have changed so much that it matters.
    fn calm(&self, loads: &mut [Load]) {
        let asleep = self.blocks.asleep().zip(self.blocks.loads());
        for (block, (load, (asleep, [force, torque]))) in loads.iter_mut().zip(asleep).enumerate() {
            let weight = self.blocks.mass(block) * self.ambient.gravity.length();
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

    /// The whole load on a block, from the fluid around it and inside it, over the last `dt` (s).
    fn load(&mut self, block: usize, pose: &Pose, dt: f64) -> Load {
        let felt = &self.felt[block];
        let made = &self.setup.setup.blocks[block];
        if made.motion != Motion::Free {
            return sum(felt.flow, felt.buoyancy);
        }
        let turn: DMat3 = pose.deformation;
        let matter = Matter {
            mass: self.blocks.mass(block),
            volume: made.shape.volume(),
            inertia: turn * made.shape.inertia() * turn.transpose(),
            gravity: self.ambient.gravity,
        };
        self.inner[block].load(felt, pose, &matter, self.ambient.density, dt)
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
