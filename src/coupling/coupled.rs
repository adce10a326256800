//! The blocks of a scene in its lattice: their cells, blocks at inlets, and the film in gaps narrower than a cell.

use super::{
    CouplingParams, FluidLoad, Gap, InteriorFluid, LatticeCoupling, Rock, gaps::gaps,
    lattice_coupling::ProbeRequest,
};
use crate::{
    Result,
    lattice::{Lattice, State},
    psm::{CellWork, NearCell, SolidBlock, SolidCells, near_cells, outline},
    rock::{
        Block, Blocks, Motion,
        law::{Film, LoadDelay},
    },
    scene::{Advice, Boundary, Domain, Face, Scene, Warning, build::BlockSetup},
    units::Units,
};
use glam::DVec3;
use std::f64::consts::PI;

/// Work of the coupling since the start or the last restart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exchanges {
    /// Number of times the host waited for loads: once per exchange.
    pub readings: u64,
    /// Computation of the blocks' cells.
    pub cells: CellWork,
}

/// Blocks in a fluid on a lattice.
#[derive(Clone, Copy, Debug)]
pub struct Coupled<'a> {
    pub(super) rock: &'a Rock,
    pub(super) coupling: &'a LatticeCoupling,
}

/// Creates the blocks of a scene from `setup` and couples them to its lattice.
///
/// # Errors
/// Returns the errors of an invalid setup of blocks, and of exceeded device limits.
pub(crate) async fn couple(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    lattice: &Lattice,
    (scene, units): (&Scene, &Units),
    setup: BlockSetup,
) -> Result<(Rock, LatticeCoupling)> {
    let mut setup = setup;
    setup.setup.film = lubrication_film(scene, units, &setup.setup.blocks);
    let in_fluid = setup.in_fluid;
    let hold = (scene.coupling.hold / units.time_step).round();
    let interval = f64::from(scene.coupling.interval) * units.time_step;
    let params = CouplingParams {
        time_step: units.time_step,
        // A margin of half a step for the rounding of times.
        hold: (hold - 0.5) * units.time_step,
        inside: Some(InteriorFluid {
            density: scene.fluid.density,
            layer: units
                .cell
                .max((PI * scene.fluid.viscosity * interval).sqrt()),
        }),
    };
    let mut rock = Rock::new(Some((device, queue)), scene, setup, Some(params)).await?;
    let gaps = gaps(
        &rock.setup.setup,
        &rock.blocks,
        in_fluid,
        units.cell,
        &mut rock.broadphase,
    )
    .await?;
    let all = &rock.setup.setup.blocks;
    let blocks = &all[..in_fluid];
    let requests = blocks
        .iter()
        .map(|block| ProbeRequest::of(scene, &block.name));
    let requests: Vec<ProbeRequest> = requests.collect();
    let solids = blocks.iter().zip(&requests).enumerate();
    let solids = solids.map(|(n, (block, request))| SolidBlock {
        shape: block.shape.clone(),
        loaded: block.motion != Motion::Fixed || request.load,
        faces: request.faces || block.deformable.is_some(),
        filled: rock.blocks.filled(n),
    });
    let solids = solids.collect();
    let period = rock.blocks.period();
    let mut coupling = LatticeCoupling::new(device, lattice, (scene, units), solids, period)?;
    coupling.gaps = gaps;
    coupling.face_probes = requests.iter().map(|request| request.faces).collect();
    coupling.deformable = blocks.iter().map(|b| b.deformable.is_some()).collect();
    let coupled = Coupled::new(&rock, &coupling);
    coupling.initial_inlet_blocks = coupled.blocks_at_inlets(scene, units);
    Ok((rock, coupling))
}

impl<'a> Coupled<'a> {
    pub(crate) fn new(rock: &'a Rock, coupling: &'a LatticeCoupling) -> Self {
        Self { rock, coupling }
    }

    /// The load of the exterior fluid on each block at the last exchange: [`Rock::external_load`].
    pub fn external_load(&self) -> &'a [FluidLoad] {
        self.rock.external_load()
    }

    /// The load of the fluid on each block at the last exchange, summed over its cells: [`Rock::cell_load`].
    pub fn cell_load(&self) -> &'a [FluidLoad] {
        self.rock.cell_load()
    }

    /// The blocks in their present state.
    pub fn blocks(&self) -> &'a Blocks {
        self.rock.blocks()
    }

    /// The setup of the blocks.
    pub fn setup(&self) -> &'a BlockSetup {
        self.rock.setup()
    }

    /// Number of blocks in the fluid. They come first in the list; solids and walls follow.
    pub fn in_fluid(&self) -> usize {
        self.rock.setup().in_fluid
    }

    /// The pairs of blocks, at least one of them in the fluid, that were less than a cell apart at the start.
    pub fn gaps(&self) -> &'a [Gap] {
        &self.coupling.gaps
    }

    /// The cells of the blocks.
    pub fn solid_cells(&self) -> &'a SolidCells {
        &self.coupling.cells
    }

    /// Work of the coupling since the start or the last restart.
    pub fn exchanges(&self) -> Exchanges {
        Exchanges {
            readings: self.rock.exchange_count(),
            cells: self.coupling.cells.work(),
        }
    }
}

/// A cell inside or near a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockCell {
    /// The block.
    pub block: usize,
    /// The cell, with its distance from the nearest part of any block.
    pub cell: NearCell,
}

impl Coupled<'_> {
    /// The cells whose centres lie at most `reach` cells from a block in the fluid, in the order of the
    /// cells, each with its nearest block.
    pub fn cells_near_blocks(&self, reach: f64) -> Vec<BlockCell> {
        let frame = self.solid_cells().frame();
        let (cells, periodic) = self.solid_cells().domain();
        let poses = self.blocks().poses();
        let (mut all, mut found) = (Vec::new(), Vec::new());
        for (block, pose) in poses.iter().enumerate().take(self.in_fluid()) {
            let parts = self.setup().setup.blocks[block].shape.parts().iter();
            let outlines: Vec<_> = parts.map(|part| outline(frame, part, pose)).collect();
            let filled = self.blocks().filled(block);
            let imaged = [0, 1, 2].map(|axis| periodic[axis] && !filled[axis]);
            for outline in &outlines {
                near_cells(outline, reach, cells, imaged, &mut found);
            }
            all.extend(found.drain(..).map(|cell| BlockCell { block, cell }));
        }
        let order = |a: &BlockCell, b: &BlockCell| {
            let indices = a.cell.index.cmp(&b.cell.index);
            indices.then(a.cell.distance.total_cmp(&b.cell.distance))
        };
        all.sort_by(order);
        all.dedup_by_key(|found| found.cell.index);
        all
    }

    /// Velocity of a block's solid at the place `x` (m) or at its periodic image nearest to the block, m/s.
    pub fn solid_velocity(&self, block: usize, x: DVec3) -> DVec3 {
        let pose = self.rock.pose(block);
        let gradient = pose.deformation_rate * pose.deformation.inverse();
        let (cells, periodic) = self.solid_cells().domain();
        let mut r = x - pose.centre;
        for axis in (0..3).filter(|&axis| periodic[axis]) {
            let period = f64::from(cells[axis]) * self.solid_cells().frame().units.cell;
            r[axis] -= period * (r[axis] / period).round();
        }
        pose.velocity + gradient * r
    }

    /// Sets the velocity of the fluid inside the blocks to that of the blocks, and in cells with a face through their centre to the
    /// mean of both. Otherwise the acceleration of the fluid to their velocity would take momentum from them.
    pub fn set_interior_velocity(&self, domain: &Domain, state: &mut State) {
        let units = self.solid_cells().frame().units;
        let cells = domain.cells();
        for found in self.cells_near_blocks(ON_FACE) {
            let at = found.cell.index;
            let centre = DVec3::from(domain.centre(found.cell.ijk(cells)));
            let velocity = self.solid_velocity(found.block, centre).to_array();
            let part = if found.cell.distance < -ON_FACE {
                1.0
            } else {
                0.5
            };
            for (field, velocity) in state.velocity.iter_mut().zip(velocity) {
                let value = &mut field[at as usize];
                let change = units.velocity_to_lattice(velocity) - f64::from(*value);
                *value = (f64::from(*value) + part * change) as f32;
            }
        }
    }

    /// The blocks in cells of velocity faces with a velocity other than zero; `through` holds the normal velocity of each
    /// cell of such a face, lower axis fastest.
    pub(crate) fn at_inlets(&self, through: &[(Face, Vec<f64>)]) -> Vec<BlockAtInlet> {
        let mut all: Vec<BlockAtInlet> = Vec::new();
        if through.is_empty() {
            return all;
        }
        let (cells, _) = self.solid_cells().domain();
        for found in self.cells_near_blocks(0.0) {
            let ijk = found.cell.ijk(cells);
            for (face, velocity) in through {
                let axis = face.axis();
                let end = if face.is_max() {
                    cells[axis.index()] - 1
                } else {
                    0
                };
                if ijk[axis.index()] != end {
                    continue;
                }
                let [low, high] = axis.others().map(|other| other.index());
                let speed = velocity[(ijk[low] + cells[low] * ijk[high]) as usize].abs();
                if speed == 0.0 {
                    continue;
                }
                let known = |at: &&mut BlockAtInlet| at.block == found.block && at.face == *face;
                match all.iter_mut().find(known) {
                    Some(known) => {
                        known.cells += 1;
                        known.speed = known.speed.max(speed);
                    }
                    None => all.push(BlockAtInlet {
                        block: found.block,
                        face: *face,
                        cells: 1,
                        first: ijk,
                        speed,
                    }),
                }
            }
        }
        all
    }

    /// Cause and remedy of a block at an inlet; `speed` in m/s.
    pub(crate) fn inlet_message(&self, found: &BlockAtInlet, speed: f64) -> [String; 2] {
        let [x, y, z] = found.first;
        let (name, face) = (self.blocks().name(found.block), found.face.name());
        [
            format!(
                "the block {name} lies in {} cells of the velocity face {face}, the first of them cell ({x}, {y}, {z}): \
                 it blocks an inflow of up to {speed:.3e} m/s",
                found.cells
            ),
            format!(
                "keep the block a cell or more away from {face}, or give boundaries.{face} a velocity formula that is 0 \
                 where the block is"
            ),
        ]
    }

    /// The blocks in inflow cells at their present poses, with the velocities at the start, in the middle and at the end
    /// of the run.
    fn blocks_at_inlets(&self, scene: &Scene, units: &Units) -> Vec<BlockAtInlet> {
        let length = scene.run.duration(units);
        let velocity_face = |(face, boundary): (Face, &Boundary)| {
            matches!(boundary, Boundary::Velocity { .. }).then_some(face)
        };
        // The largest speed of each cell. A formula that is not finite at a later time fails at that time.
        let largest = |face: Face| {
            let mut all: Vec<f64> = Vec::new();
            for time in [0.0, 0.5 * length, length] {
                let velocity = scene.face_velocity(face, time).unwrap_or_default();
                let speeds = velocity.into_iter().map(|u| u[face.axis().index()].abs());
                if all.is_empty() {
                    all = speeds.collect();
                } else {
                    all.iter_mut().zip(speeds).for_each(|(a, b)| *a = a.max(b));
                }
            }
            (face, all)
        };
        let faces = scene.boundaries.iter().filter_map(velocity_face);
        let through: Vec<_> = faces
            .map(largest)
            .filter(|(_, all)| !all.is_empty())
            .collect();
        self.at_inlets(&through)
    }

    /// Adds warnings about blocks in inflow cells.
    pub(super) fn warn_of_inlets(&self, advice: &mut Advice) {
        for found in &self.coupling.initial_inlet_blocks {
            let [cause, remedy] = self.inlet_message(found, found.speed);
            advice.push(Warning {
                place: format!("boundaries.{}", found.face.name()),
                message: format!("{cause}, and the run may diverge; {remedy}"),
            });
        }
    }

    /// Cause and remedy of the first block in inflow cells at the start.
    pub(crate) fn initial_inlet_message(&self) -> Option<[String; 2]> {
        let found = self.coupling.initial_inlet_blocks.first()?;
        let [cause, remedy] = self.inlet_message(found, found.speed);
        Some([format!("at the start {cause}"), remedy])
    }
}

/// A block that covers the centres of cells at a velocity face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BlockAtInlet {
    pub block: usize,
    pub face: Face,
    /// Number of cells.
    pub cells: usize,
    /// The first of these cells.
    pub first: [u32; 3],
    /// Largest normal velocity through these cells, in the unit of the given velocities.
    pub speed: f64,
}

/// Distance, cells, up to which a face passes through the centre of a cell: above rounding.
const ON_FACE: f64 = 1e-6;
/// Roughness of faces, cells: that of rock is a thousandth to a hundredth of the size of a block, which spans some
/// tens of cells.
const ROUGHNESS: f64 = 0.1;
/// Gap of curved surfaces, cells, below which the grid does not resolve the force. For a sphere that approaches a wall
/// the lattice yields 0.91 of the force at a gap of one cell, 0.78 at half a cell and 0.55 at a quarter. A limit of 2/3 of
/// a cell (as Nguyen & Ladd 2002 found with other walls) leaves errors of −2, +13 and +11 % at 0.5, 0.25 and 0.12 cells.
const CURVED_GAP: f64 = 2.0 / 3.0;
/// The same limit for plane faces, between which the force grows with the third power of the gap: the lattice yields 0.92
/// of it at a cell, 0.21 at half a cell, and 0.04 at a quarter.
const PLANE_GAP: f64 = 0.8;

/// Gap of plane faces, cells, below which both may lie in one cell, whose water then acts as a spring between them.
const SHARED_CELL: f64 = 1.0;
/// Exchanges over which velocities are averaged: nearly a period of the oscillations that delayed loads would drive, 20
/// steps for blocks three cells thick.
const DELAY_MEMORY: f64 = 16.0;

/// The delay of the loads in shared cells. Pressure corresponds to the constant velocity of the blocks in the middle of an
/// exchange. Loads are evaluated before a step, which adds half a step of delay, and the mean of two loads adds another
/// half.
fn load_delay(scene: &Scene, units: &Units) -> LoadDelay {
    let interval = f64::from(scene.coupling.interval);
    let steps = 0.5 * interval + if scene.averages_loads() { 1.0 } else { 0.5 };
    LoadDelay {
        // ρ c² t/Δx with c² = (Δx/Δt)²/3.
        impedance: scene.fluid.density * units.cell / units.time_step * steps / 3.0,
        range: SHARED_CELL * units.cell,
        memory: DELAY_MEMORY * interval * units.time_step,
    }
}

/// The lubrication film in unresolved gaps; `None` without `coupling.lubrication`.
fn lubrication_film(scene: &Scene, units: &Units, blocks: &[Block]) -> Option<Film> {
    let faces = scene.boundaries.iter();
    let free_slip = faces.filter(|(_, boundary)| matches!(boundary, Boundary::FreeSlip));
    let mut slip: Vec<usize> = free_slip
        .map(|(face, _)| format!("wall_{}", face.name()))
        .filter_map(|name| blocks.iter().position(|block| block.name == name))
        .collect();
    slip.sort_unstable();
    scene.coupling.lubrication.then_some(Film {
        viscosity: scene.fluid.density * scene.fluid.viscosity,
        round: CURVED_GAP * units.cell,
        flat: PLANE_GAP * units.cell,
        roughness: ROUGHNESS * units.cell,
        delay: Some(load_delay(scene, units)),
        slip,
    })
}
