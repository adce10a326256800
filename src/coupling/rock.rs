//! The blocks of a scene, alone or coupled to any fluid, from their state at the time 0.

use super::{
    AddedMass, ExchangeInterval, FluidLoad, InteriorInertia, MassProperties, fluid_load::add_loads,
};
use crate::{
    Error, Result,
    geometry::{Load, Pose, Shape, skew},
    rock::{
        Block, Blocks, Motion, Snapshot,
        broadphase::{AutoBroadphase, Broadphase},
    },
    scene::{
        BroadphaseBackend, Scene, Warning,
        build::{BlockSetup, rock_key},
    },
};
use glam::{DMat3, DVec3};
use std::{sync::Arc, time::Instant};

/// Number of exchange intervals between two exchanges while all blocks are asleep.
const ASLEEP_INTERVALS: u64 = 16;
/// Change of the load on a sleeping block that does not wake it, as a fraction of its weight: far above the rounding
/// of sums over cells and the last swirls in still water, far below the load that moves a block.
const SLEEP_TOLERANCE: f64 = 1e-3;

/// Parameters of the coupling of blocks to a fluid.
#[derive(Clone, Copy, Debug)]
pub struct CouplingParams {
    /// Time step of the fluid, s; also that of the blocks if none of them is free.
    pub time_step: f64,
    /// Blocks are held in all exchanges that begin before this time, s.
    pub hold: f64,
    /// The fluid inside the blocks; `None` if blocks displace it.
    pub inside: Option<InteriorFluid>,
}

/// A fluid that also fills the interior of blocks.
#[derive(Clone, Copy, Debug)]
pub struct InteriorFluid {
    /// Density of the fluid, kg/m³.
    pub density: f64,
    /// Thickness of the viscous layer that moves with a block between two exchanges, m: at least a cell, or the diffusion
    /// length in that time.
    pub layer: f64,
}

/// The blocks of a scene, alone or coupled to a fluid.
#[derive(Debug)]
pub struct Rock {
    pub(super) setup: BlockSetup,
    pub(super) blocks: Blocks,
    pub(super) broadphase: AutoBroadphase,
    interval: u64,
    /// Time between two exchanges while a block is awake, s.
    exchange_time: f64,
    hold: f64,
    inside: Option<InteriorFluid>,
    /// Upper bounds of the added mass of each block.
    added_mass: Vec<AddedMass>,
    /// Load of the fluid on the cells of each block at the last exchange; empty without a fluid.
    pub(super) cell_load: Vec<FluidLoad>,
    external_load: Vec<FluidLoad>,
    pub(super) interior: Vec<InteriorInertia>,
    /// State before an exchange, restored if it fails; kept to reuse its memory.
    backup: (Snapshot, Vec<InteriorInertia>),
    exchanges: u64,
    /// Time of exchanges on the host, s, if requested.
    exchange_time_spent: Option<f64>,
    /// Work of the free and driven blocks on the fluid since the start, J.
    pub(crate) work_on_fluid: f64,
}

impl Rock {
    /// The blocks of a scene from `setup`, pushed apart if the scene requests it; `params` describe its fluid, if it has one.
    /// Without a `device`, the broadphase runs on the host.
    ///
    /// # Errors
    /// Returns the errors of [`Blocks`] for an invalid setup; [`crate::Error::Overlaps`] if blocks overlap, or cannot be
    /// pushed apart; [`crate::Error::TimeStep`] if the step is too long for the contacts at the start.
    pub async fn new(
        device: Option<(&wgpu::Device, &wgpu::Queue)>,
        scene: &Scene,
        setup: BlockSetup,
        params: Option<CouplingParams>,
    ) -> Result<Self> {
        let mut setup = setup;
        let free = |block: &Block| block.motion == Motion::Free;
        if let Some(params) = &params
            && setup.setup.time_step.is_none()
            && !setup.setup.blocks.iter().any(free)
        {
            // Without free blocks no contact limits the step.
            setup.setup.time_step = Some(params.time_step);
        }
        let mut broadphase = broadphase(device, scene)?;
        let (blocks, thrown) = begin(scene, &setup, &mut broadphase).await?;
        setup.advice.extend(thrown);
        let inside = params.and_then(|params| params.inside);
        let coupled = if params.is_some() { blocks.len() } else { 0 };
        Ok(Self {
            interval: scene.coupling.interval.into(),
            exchange_time: params.map_or(0.0, |params| {
                f64::from(scene.coupling.interval) * params.time_step
            }),
            hold: params.map_or(0.0, |params| params.hold),
            inside,
            added_mass: inside.map_or_else(Vec::new, |inside| {
                let shapes = setup.setup.blocks.iter().map(|block| &block.shape);
                let bound = |shape: &Arc<Shape>| {
                    AddedMass::bound(shape.volume(), shape.inertia(), inside.layer)
                };
                shapes.map(bound).collect()
            }),
            cell_load: vec![FluidLoad::default(); coupled],
            external_load: vec![FluidLoad::default(); coupled],
            interior: vec![InteriorInertia::default(); coupled],
            backup: (Snapshot::default(), Vec::new()),
            exchanges: 0,
            exchange_time_spent: None,
            work_on_fluid: 0.0,
            setup,
            blocks,
            broadphase,
        })
    }

    /// Poses of the blocks; their velocities are zero while the blocks are held.
    pub fn poses(&self) -> Vec<Pose> {
        (0..self.blocks.len())
            .map(|block| self.pose(block))
            .collect()
    }

    /// The pose of a block, as in [`Rock::poses`].
    pub(super) fn pose(&self, block: usize) -> Pose {
        let mut pose = self.blocks.pose(block);
        if self.is_held() {
            (pose.velocity, pose.deformation_rate) = (DVec3::ZERO, DMat3::ZERO);
        }
        pose
    }

    /// Whether the blocks are held in an exchange that begins now.
    fn is_held(&self) -> bool {
        self.blocks.time() < self.hold
    }

    /// Whether a block can move at all.
    pub fn moves(&self) -> bool {
        (0..self.blocks.len()).any(|block| self.blocks.moves(block))
    }

    /// The interval until the next exchange.
    pub fn exchange_interval(&self) -> ExchangeInterval {
        if !self.moves() {
            return ExchangeInterval::Static;
        }
        let mut all = self.blocks.asleep().enumerate();
        if all.all(|(block, asleep)| asleep || !self.blocks.moves(block)) {
            ExchangeInterval::Asleep(self.interval * ASLEEP_INTERVALS)
        } else {
            let longer = match self.blocks.may_all_sleep_within(2.0 * self.exchange_time) {
                true => ASLEEP_INTERVALS,
                false => 1,
            };
            ExchangeInterval::Awake {
                steps: self.interval,
                next: longer * self.interval,
            }
        }
    }

    /// Advances the blocks to the time `until` (s) under the mean loads since the previous exchange.
    ///
    /// # Errors
    /// Returns the errors of [`Blocks::advance`]. The blocks then keep their state.
    pub async fn exchange(&mut self, loads: &[FluidLoad], until: f64) -> Result<()> {
        let start = self.exchange_time_spent.map(|_| Instant::now());
        let moved = self.exchange_loads(loads, until).await;
        if let (Some(spent), Some(start)) = (&mut self.exchange_time_spent, start) {
            *spent += start.elapsed().as_secs_f64();
        }
        moved
    }

    async fn exchange_loads(&mut self, loads: &[FluidLoad], until: f64) -> Result<()> {
        self.exchanges += 1;
        for (old, new) in self.cell_load.iter_mut().zip(loads) {
            *old = *new;
        }
        if !self.moves() || self.is_held() {
            self.external_load.clone_from(&self.cell_load);
            if self.moves() {
                self.blocks.skip_to(until)?;
            }
            return Ok(());
        }
        let dt = until - self.blocks.time();
        self.blocks.save(&mut self.backup.0);
        self.backup.1.clone_from(&self.interior);
        let poses = self.blocks.poses();
        let mut loads: Vec<Load> = (0..poses.len())
            .map(|block| self.load(block, &poses[block], dt))
            .collect();
        self.keep_sleeping_loads(&mut loads);
        self.blocks.set_load_interval(dt);
        let moved = match self.blocks.set_loads(&loads) {
            Ok(()) => self.blocks.advance(&mut self.broadphase, until).await,
            refused => refused,
        };
        if moved.is_err() {
            self.interior.clone_from(&self.backup.1);
            self.blocks.restore(&self.backup.0)?;
        } else {
            let moves = poses.iter().zip(self.blocks.poses());
            let work = |(load, (from, to)): (&Load, (&Pose, Pose))| load.work(from, &to);
            self.work_on_fluid -= loads.iter().zip(moves).map(work).sum::<f64>();
            self.update_external_load();
        }
        moved
    }

    /// Advances blocks without a fluid to the time `until` (s).
    ///
    /// # Errors
    /// Returns the errors of [`Blocks::advance`]. The blocks then keep their state.
    pub async fn advance(&mut self, until: f64) -> Result<()> {
        // A failed sub-step leaves the blocks unchanged, so that a single one needs no backup.
        let several = self.blocks.steps_to(until) > 1.0;
        if several {
            self.blocks.save(&mut self.backup.0);
        }
        let moved = self.blocks.advance(&mut self.broadphase, until).await;
        if moved.is_err() && several {
            self.blocks.restore(&self.backup.0)?;
        }
        moved
    }

    /// Keeps the previous loads on sleeping blocks unless the change exceeds [`SLEEP_TOLERANCE`].
    fn keep_sleeping_loads(&self, loads: &mut [Load]) {
        let asleep = self.blocks.asleep().zip(self.blocks.loads());
        for (block, (load, (asleep, [force, torque]))) in loads.iter_mut().zip(asleep).enumerate() {
            let weight = self.blocks.mass(block) * self.blocks.gravity().length();
            let scale = SLEEP_TOLERANCE * if weight > 0.0 { weight } else { force.length() };
            let radius = self.setup.setup.blocks[block].shape.radius();
            if asleep
                && (load.force - force).length() <= scale
                && (load.torque() - torque).length() <= scale * radius
            {
                (load.force, load.moment) = (force, 0.5 * skew(torque));
            }
        }
    }

    /// The total load on a block over the last `dt` (s), by the fluid around it and any fluid inside it.
    fn load(&mut self, block: usize, pose: &Pose, dt: f64) -> Load {
        let cell_load = &self.cell_load[block];
        let made = &self.setup.setup.blocks[block];
        let Some(InteriorFluid { density, .. }) = self.inside else {
            return add_loads(cell_load.flow, cell_load.buoyancy);
        };
        if made.motion != Motion::Free {
            self.interior[block].prescribe_motion(pose, dt);
            return add_loads(cell_load.flow, cell_load.buoyancy);
        }
        let properties = MassProperties {
            mass: self.blocks.mass(block),
            volume: made.shape.volume(),
            inertia: rotated_inertia(pose, made.shape.inertia()),
            gravity: self.blocks.gravity(),
            added: self.added_mass[block],
        };
        self.interior[block].load(cell_load, pose, &properties, density, dt)
    }

    /// Separates the load of the exterior fluid from the load that moved the blocks.
    fn update_external_load(&mut self) {
        let held = self.is_held();
        let (loads, poses): (Vec<_>, _) = (self.blocks.loads().collect(), self.blocks.poses());
        self.external_load.clone_from(&self.cell_load);
        let Some(InteriorFluid { density, .. }) = self.inside.filter(|_| !held) else {
            return;
        };
        for (block, external) in self.external_load.iter_mut().enumerate() {
            let (made, interior) = (&self.setup.setup.blocks[block], &self.interior[block]);
            match &made.motion {
                Motion::Free if interior.is_initialised() => {
                    let [force, torque] = loads[block];
                    let torque = torque - external.buoyancy.torque() - external.flow.torque();
                    external.flow.force = force - external.buoyancy.force;
                    external.flow.moment += 0.5 * skew(torque);
                }
                Motion::Driven { .. } => {
                    let shape = &made.shape;
                    let inertia = rotated_inertia(&poses[block], shape.inertia());
                    external.flow =
                        interior.external_load(external, inertia, shape.volume(), density);
                }
                _ => {}
            }
        }
    }

    /// The load of the exterior fluid on each block at the last exchange: the load that moves it besides weight and
    /// contacts. It excludes the inertia of the fluid inside the cells of the block, which [`Rock::cell_load`] includes.
    /// Empty without a fluid.
    pub fn external_load(&self) -> &[FluidLoad] {
        &self.external_load
    }

    /// The load of the fluid on each block at the last exchange, summed over its cells; it includes the inertia of the
    /// fluid inside them.
    pub fn cell_load(&self) -> &[FluidLoad] {
        &self.cell_load
    }

    /// Starts timing the phases of the steps of the blocks.
    pub fn time_phases(&mut self) {
        self.blocks.time_phases();
        self.exchange_time_spent.get_or_insert(0.0);
    }

    /// Time of the exchanges since [`Rock::time_phases`] on the host, s, including the steps of the blocks; zero without a
    /// fluid.
    pub fn exchange_time_spent(&self) -> f64 {
        self.exchange_time_spent.unwrap_or_default()
    }

    /// The blocks in their present state.
    pub fn blocks(&self) -> &Blocks {
        &self.blocks
    }

    /// The setup of the blocks.
    pub fn setup(&self) -> &BlockSetup {
        &self.setup
    }

    /// Number of exchanges since the start or the last restart.
    pub fn exchange_count(&self) -> u64 {
        self.exchanges
    }

    /// The present state, for a later [`Rock::restore`].
    pub fn state(&self) -> RockState {
        RockState {
            snapshot: self.blocks.snapshot(),
            interior: self.interior.clone(),
            cell_load: self.cell_load.clone(),
            work_on_fluid: self.work_on_fluid,
        }
    }

    /// Restores a state of the same blocks: the next steps yield the same bits.
    ///
    /// # Errors
    /// [`Error::Argument`] if the state belongs to other blocks.
    pub fn restore(&mut self, state: &RockState) -> Result<()> {
        let own = [self.interior.len(), self.cell_load.len()];
        if [state.interior.len(), state.cell_load.len()] != own {
            let message = format!(
                "the checkpoint has loads on {} blocks, and the scene {}; restart with the scene that wrote it",
                state.cell_load.len(),
                self.cell_load.len()
            );
            return Err(Error::argument("restart", message));
        }
        self.blocks
            .restore(&state.snapshot)
            .map_err(|error| Error::argument("restart", error.to_string()))?;
        self.interior.clone_from(&state.interior);
        self.cell_load.clone_from(&state.cell_load);
        self.work_on_fluid = state.work_on_fluid;
        self.update_external_load();
        Ok(())
    }
}

/// The state of the blocks of a scene, without their fluid: everything on which their next steps depend.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct RockState {
    /// The blocks.
    pub snapshot: Snapshot,
    /// Inertia of the fluid inside each block; empty without a fluid.
    interior: Vec<InteriorInertia>,
    /// Load on each block in the last exchange; empty without a fluid.
    cell_load: Vec<FluidLoad>,
    /// Work of the blocks on the fluid since the start, J.
    work_on_fluid: f64,
}

/// The inertia tensor of a body in its present orientation.
fn rotated_inertia(pose: &Pose, inertia: DMat3) -> DMat3 {
    pose.deformation * inertia * pose.deformation.transpose()
}

/// Largest number of sweeps over all pairs that push overlapping blocks apart; each sweep settles a layer of a pile, so this
/// is enough for any pile that a scene defines by hand.
const SWEEPS: usize = 1000;

/// The broadphase of the blocks of a scene, on `device` if there is one and the scene permits it.
///
/// # Errors
/// [`Error::Scene`] if the scene requires a device and there is none.
pub(super) fn broadphase(
    device: Option<(&wgpu::Device, &wgpu::Queue)>,
    scene: &Scene,
) -> Result<AutoBroadphase> {
    let backend = scene.rock.broadphase;
    let broadphase = match (device, backend) {
        (Some((device, queue)), BroadphaseBackend::Auto | BroadphaseBackend::Device) => {
            let processor = scene.run.kernels.processor(&device.adapter_info());
            let auto = scene.rock.broadphase_crossover;
            let auto = auto.unwrap_or(AutoBroadphase::crossover_on(processor));
            let mut broadphase = AutoBroadphase::new(device, queue);
            broadphase.crossover = if backend == BroadphaseBackend::Device {
                0
            } else {
                auto
            };
            broadphase
        }
        (None, BroadphaseBackend::Device) => {
            let message = "the broadphase requires a device, and none was given; give one, or use broadphase = \"host\"";
            return Err(Error::scene("rock.broadphase", message));
        }
        (_, BroadphaseBackend::Host) | (None, BroadphaseBackend::Auto) => AutoBroadphase::on_host(),
    };
    Ok(broadphase)
}

/// The blocks of a scene at the time 0, pushed apart if the scene requests it, and a warning if contacts throw blocks apart. A
/// trial sub-step, which is then undone, detects these, larger overlaps, and a time step that is too long before the run.
///
/// # Errors
/// [`Error::Overlaps`] if blocks overlap, or cannot be pushed apart; [`Error::TimeStep`] if the step is too long for the
/// contacts at the start.
pub(super) async fn begin(
    scene: &Scene,
    setup: &BlockSetup,
    broadphase: &mut impl Broadphase,
) -> Result<(Blocks, Option<Warning>)> {
    let mut thrown = None;
    let mut blocks = Blocks::new(setup.setup.clone()).map_err(|error| error.at_key(rock_key))?;
    if scene.rock.relax {
        blocks.relax(broadphase, SWEEPS).await?;
    }
    if blocks.time_step().is_finite() {
        let start = blocks.snapshot();
        let pairs = broadphase.pairs(&blocks.aabbs()).await?;
        blocks.set_pairs(pairs)?;
        blocks.step()?;
        thrown = thrown_apart(setup, &blocks);
        blocks.restore(&start)?;
        blocks.reset_peak_speed();
    }
    Ok((blocks, thrown))
}

/// A warning of the pair of blocks that the springs of its contact throw apart the fastest, if any lifts a block against gravity by
/// more than 1 % of its radius.
fn thrown_apart(setup: &BlockSetup, blocks: &Blocks) -> Option<Warning> {
    const LIFT: f64 = 0.01;
    // Also without gravity, blocks that just touch are not thrown apart: overlap as a fraction of the radius.
    const TOUCHING: f64 = 1e-5;
    let (mut fastest, mut found) = (0.0, None);
    for contact in blocks.contacts() {
        let energy = 0.5 * contact.force.dot(contact.normal) * contact.overlap;
        let all = contact.blocks.map(|block| &setup.setup.blocks[block]);
        let mass = |k: usize| match all[k].motion {
            Motion::Free => blocks.mass(contact.blocks[k]),
            _ => f64::INFINITY,
        };
        let lighter = if mass(0) <= mass(1) { 0 } else { 1 };
        let (mass, other) = (mass(lighter), mass(1 - lighter));
        let radius = all[lighter].shape.radius();
        let weight = mass * blocks.gravity().length();
        let speed = (2.0 * energy * (1.0 / mass + 1.0 / other)).sqrt();
        if energy > LIFT * radius * weight && contact.overlap > TOUCHING * radius && speed > fastest
        {
            fastest = speed;
            found = Some((all, contact.overlap, energy));
        }
    }
    let ([first, second], overlap, energy) = found?;
    Some(Warning {
        place: format!("block {}", second.name),
        message: format!(
            "it overlaps `{}` by {overlap:.2e} m at the start, and the springs of their contact hold {energy:.2e} J: they can throw \
             it off at {fastest:.2e} m/s; move one of them, or set relax = true in [rock]",
            first.name
        ),
    })
}
