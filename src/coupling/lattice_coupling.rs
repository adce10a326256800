//! Blocks coupled to a lattice: their cells, and the loads that the lattice returns.

use super::{
    Ambient, AsyncReadback, Copied, Coupled, ExchangeInterval, FluidLoad, Gap, LoadAverage,
    coupled::BlockAtInlet, fluid_load::add_loads, strain_load::with_strain_part,
};
use crate::{
    Error, Result,
    error::refused,
    formula::Formula,
    geometry::{Load, Pose},
    gpu::timer::{Phases, begin_pass},
    lattice::Lattice,
    psm::{FaceLoad, Frame, SolidBlock, SolidCells},
    rock::Period,
    scene::{ProbePlace, Scene},
    units::Units,
};
use glam::DVec3;
use std::time::Instant;

/// The cells of blocks in a lattice, and the loads of the fluid on these blocks.
#[derive(Debug)]
pub(crate) struct LatticeCoupling {
    pub(super) cells: SolidCells,
    pub(super) load_readback: AsyncReadback,
    pub(super) face_readback: AsyncReadback,
    /// Loads on the faces of each block in the fluid; empty before the first exchange.
    pub(super) face_loads: Vec<Vec<FaceLoad>>,
    pub(super) ambient: Ambient,
    pub(super) load_average: LoadAverage,
    /// Whether each load is averaged with the load of the previous step.
    average: bool,
    /// Number of blocks in the fluid; they come first in the list.
    pub(super) in_fluid: usize,
    /// Poses of all blocks for which the cells have been computed.
    pub(super) placed: Option<Vec<Pose>>,
    /// Pairs of blocks closer than a cell at the start.
    pub(super) gaps: Vec<Gap>,
    /// Whether a probe requests the loads on the faces of each block in the fluid.
    pub(super) face_probes: Vec<bool>,
    /// Whether each block in the fluid is deformable.
    pub(super) deformable: Vec<bool>,
    /// Blocks in inflow cells at the start.
    pub(super) initial_inlet_blocks: Vec<BlockAtInlet>,
}

impl LatticeCoupling {
    pub(super) fn new(
        device: &wgpu::Device,
        lattice: &Lattice,
        (scene, units): (&Scene, &Units),
        blocks: Vec<SolidBlock>,
        period: Option<Period>,
    ) -> Result<Self> {
        let frame = Frame {
            origin: DVec3::from(scene.domain.origin),
            units: *units,
        };
        Ok(Self {
            in_fluid: blocks.len(),
            cells: SolidCells::new(device, lattice, frame, blocks)?,
            load_readback: AsyncReadback::default(),
            face_readback: AsyncReadback::default(),
            face_loads: Vec::new(),
            ambient: Ambient {
                density: scene.fluid.density,
                acceleration: scene.fluid.acceleration.clone(),
                gravity: DVec3::from(scene.rock.gravity),
                period,
            },
            load_average: LoadAverage::default(),
            average: scene.averages_loads(),
            placed: None,
            gaps: Vec::new(),
            face_probes: Vec::new(),
            deformable: Vec::new(),
            initial_inlet_blocks: Vec::new(),
        })
    }

    /// Sets the body force per mass on the fluid, m/s², to a uniform value.
    pub fn set_acceleration(&mut self, acceleration: [f64; 3]) {
        self.ambient.acceleration = acceleration.map(Formula::from);
    }

    /// Places the blocks at `poses` and records the computation of their cells, unless they are up to date.
    ///
    /// # Errors
    /// [`Error::Device`] if the device runs out of memory for the cells; the simulation must then be created anew.
    pub async fn place(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lattice: &mut Lattice,
        (encoder, phases): (&mut wgpu::CommandEncoder, &mut Option<Phases>),
        poses: &[Pose],
    ) -> Result<()> {
        if self.placed.as_deref() == Some(poses) {
            return Ok(());
        }
        self.placed = None;
        let start = phases.is_some().then(Instant::now);
        let in_fluid = self.in_fluid;
        let cells = &mut self.cells;
        let place = async { cells.place(device, queue, lattice, &poses[..in_fluid]) };
        let (placed, refused) = refused(device, place).await;
        placed?;
        if let Some(error) = refused {
            return Err(Error::Device(format!(
                "it does not hold the cells of {in_fluid} blocks in the fluid ({error}); use fewer or smaller ones, or \
                 a larger cell"
            )));
        }
        if let (Some(phases), Some(start)) = (&mut *phases, start) {
            phases.add("place blocks", start.elapsed().as_secs_f64());
        }
        self.cells
            .record_cells(&mut begin_pass(phases, encoder, "voxelise"));
        self.placed = Some(poses.to_vec());
        Ok(())
    }

    /// Whether an exchange takes place at the end of the step `step` (counted from 1) of an advance that ends with the
    /// step `last`.
    pub fn exchanges_at(&self, interval: ExchangeInterval, step: u64, last: u64) -> bool {
        match interval {
            // The loads move no block; output reads them after the last step.
            ExchangeInterval::Static => step == last && self.cells.wrench_count() > 0,
            ExchangeInterval::Asleep(steps) | ExchangeInterval::Awake { steps, .. } => {
                step.is_multiple_of(steps)
            }
        }
    }

    /// Whether the loads of the step `step` (counted from 1) are needed: every step while a block moves; otherwise the
    /// step of an exchange and, for the average, the step before it.
    pub fn needs_loads(&self, interval: ExchangeInterval, step: u64, last: u64) -> bool {
        matches!(interval, ExchangeInterval::Awake { .. })
            || self.exchanges_at(interval, step, last)
            || self.average && self.exchanges_at(interval, step + 1, last)
    }

    /// Whether the exchange of the step `step` in an advance that ends with the step `last` needs the loads on faces: always
    /// for deformable blocks; otherwise if it may be the last one, because output reads those of the last exchange.
    pub fn needs_faces(&self, interval: ExchangeInterval, step: u64, last: u64) -> bool {
        match interval {
            _ if self.deformable.contains(&true) => true,
            ExchangeInterval::Static => true,
            ExchangeInterval::Asleep(steps) | ExchangeInterval::Awake { next: steps, .. } => {
                step + steps > last
            }
        }
    }

    /// Records the sums of the loads on the blocks in the step `step`, and their copy to the host.
    pub fn record_loads(
        &mut self,
        device: &wgpu::Device,
        (encoder, phases): (&mut wgpu::CommandEncoder, &mut Option<Phases>),
        step: u64,
    ) {
        let mut pass = begin_pass(phases, encoder, "reduce");
        self.cells.record_loads(&mut pass);
        drop(pass);
        let sums = Copied {
            buffer: self.cells.wrenches(),
            count: self.cells.wrench_count(),
        };
        self.load_readback.record(device, encoder, sums, step);
    }

    /// Waits for the recorded loads and adds them to the average since the last exchange: all of them if a block is `moving`,
    /// otherwise only those of the last step, so that the output does not depend on how the steps were divided into advances.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn read_loads(&mut self, moving: bool) -> Result<()> {
        let recorded = self.load_readback.finish().await?;
        let last = recorded.last().map_or(0, |(step, _)| *step);
        for (step, sums) in recorded {
            let poses = self.placed.iter().flatten();
            let flow = |(load, pose): (Load, &Pose)| {
                add_loads(load, self.ambient.entrained_weight(&load, pose.centre))
            };
            let loads = self.cells.loads(&sums)?.into_iter().zip(poses);
            let loads = loads.map(flow).collect();
            match moving || step == last {
                true => self.load_average.add(step, loads, self.average),
                false => self.load_average.store(step, loads),
            }
        }
        self.read_faces().await
    }

    /// Returns the mean loads on the blocks since the last exchange, and starts a new average. The cells of a block also contain
    /// the pressure of the fluid inside it, which strains no rock: deformable blocks have the stress of the loads on their faces.
    pub fn exchange(&mut self) -> Vec<FluidLoad> {
        let flows = self.load_average.take().unwrap_or_default();
        let load = |(block, mut flow): (usize, Load)| {
            if self.deformable[block]
                && let (Some(faces), Some(poses)) = (self.face_loads.get(block), &self.placed)
            {
                let centre = poses[block].centre;
                let body_force = self.ambient.body_force(centre);
                flow.moment = with_strain_part(flow.moment, faces, centre, body_force);
            }
            FluidLoad {
                flow,
                buoyancy: self.ambient.buoyancy(&flow),
            }
        };
        flows.into_iter().enumerate().map(load).collect()
    }

    /// Records the sums of the loads on single faces in the step `step`, and their copy to the host; nothing unless a
    /// block requests them.
    pub fn record_faces(
        &mut self,
        device: &wgpu::Device,
        (encoder, phases): (&mut wgpu::CommandEncoder, &mut Option<Phases>),
        step: u64,
    ) {
        let Some(buffer) = self.cells.face_sums() else {
            return;
        };
        let mut pass = begin_pass(phases, encoder, "reduce faces");
        self.cells.record_faces(&mut pass);
        drop(pass);
        let sums = Copied {
            buffer,
            count: self.cells.face_sum_count(),
        };
        self.face_readback.record(device, encoder, sums, step);
    }

    /// Waits for the recorded loads on faces, which are the loads at the beginning of the step.
    async fn read_faces(&mut self) -> Result<()> {
        for (_, sums) in self.face_readback.finish().await? {
            let poses = self.placed.iter().flatten();
            let loads = self.cells.face_loads(&sums)?;
            let at_faces = |(loads, pose): (Vec<FaceLoad>, &Pose)| {
                let load = |load: FaceLoad| {
                    let body_force = self.ambient.body_force(load.centre);
                    load.at_face(body_force, pose.centre)
                };
                loads.into_iter().map(load).collect()
            };
            self.face_loads = loads.into_iter().zip(poses).map(at_faces).collect();
        }
        Ok(())
    }

    /// The present state, for a later [`LatticeCoupling::restore`]; waits for the loads in flight.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn state(&mut self) -> Result<CouplingState> {
        self.read_loads(true).await?;
        Ok(CouplingState {
            load_average: self.load_average.clone(),
            face_loads: self.face_loads.clone(),
            tiled: self.cells.tiled(),
        })
    }

    /// Checks that a state has the same number of blocks in the fluid.
    ///
    /// # Errors
    /// [`Error::Argument`] if it does not.
    pub fn check(&self, state: &CouplingState) -> Result<()> {
        let known = |loads: usize| loads == 0 || loads == self.in_fluid;
        let last = state.load_average.last.as_ref();
        if state.tiled.len() == self.in_fluid
            && known(state.load_average.sum.len())
            && known(state.face_loads.len())
            && last.is_none_or(|(_, loads)| loads.len() == self.in_fluid)
        {
            return Ok(());
        }
        let message = format!(
            "the checkpoint has {} blocks in the fluid, and the scene {}; restart with the scene that wrote it",
            state.tiled.len(),
            self.in_fluid
        );
        Err(Error::argument("restart", message))
    }

    /// Restores a state of the same blocks, which [`LatticeCoupling::check`] accepts.
    pub fn restore(&mut self, state: &CouplingState) {
        self.load_readback.discard();
        self.face_readback.discard();
        self.face_loads.clone_from(&state.face_loads);
        self.load_average.clone_from(&state.load_average);
        self.cells.tile(&state.tiled);
        self.placed = None;
    }
}

/// The state of the coupling of blocks to a lattice.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct CouplingState {
    load_average: LoadAverage,
    /// Loads on the faces of each block at the last exchange.
    face_loads: Vec<Vec<FaceLoad>>,
    /// Pose of each block in the fluid at its last tile search: the tiles determine the order of summation, and thus the
    /// rounding of loads.
    tiled: Vec<Option<Pose>>,
}

impl<'a> Coupled<'a> {
    /// The loads of the fluid on the faces of a block at the last exchange, part by part; empty unless a probe requests
    /// them, and before the first exchange.
    pub fn face_loads(&self, block: usize) -> &'a [FaceLoad] {
        if self.coupling.face_probes.get(block) != Some(&true) {
            return &[];
        }
        let loads = self.coupling.face_loads.get(block);
        loads.map_or(&[], Vec::as_slice)
    }
}

/// The loads on a block that the probes of a scene request.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ProbeRequest {
    /// Whether a probe follows the block.
    pub load: bool,
    /// Whether a probe needs the loads on its faces, for a table or for factors of safety.
    pub faces: bool,
}

impl ProbeRequest {
    pub fn of(scene: &Scene, name: &str) -> Self {
        let faces = |place: &ProbePlace| match place {
            ProbePlace::Block {
                block,
                faces,
                safety,
            } if block == name => Some(*faces || *safety),
            _ => None,
        };
        let probes = || scene.probes.iter().filter_map(|probe| faces(&probe.place));
        Self {
            load: probes().next().is_some(),
            faces: probes().any(|faces| faces),
        }
    }
}
