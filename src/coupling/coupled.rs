//! The blocks of a scene in its lattice.

use super::{
    CouplingParams, FluidLoad, Gap, InteriorFluid, LatticeCoupling, Rock, gaps::gaps,
    lattice_coupling::ProbeRequest, lubrication::lubrication_film,
};
use crate::{
    Result,
    lattice::Lattice,
    psm::{CellWork, SolidBlock, SolidCells},
    rock::{Blocks, Motion},
    scene::{Scene, build::BlockSetup},
    units::Units,
};
use std::f64::consts::PI;

/// Work of the coupling since the start or the last restart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exchanges {
    /// Times that the host waited for loads: once for each exchange.
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

/// The blocks of a scene, as `setup` has them, and their coupling to its lattice.
///
/// # Errors
/// Those of an invalid setup of blocks, and limits of the device.
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
        // Half a step of margin for the rounding of times.
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
    let solids = blocks.iter().zip(&requests);
    let solids = solids.map(|(block, request)| SolidBlock {
        shape: block.shape.clone(),
        loaded: block.motion != Motion::Fixed || request.load,
        faces: request.faces,
    });
    let solids = solids.collect();
    let period = rock.blocks.period();
    let mut coupling = LatticeCoupling::new(device, lattice, (scene, units), solids, period)?;
    coupling.gaps = gaps;
    coupling.face_probes = requests.iter().map(|request| request.faces).collect();
    let coupled = Coupled::new(&rock, &coupling);
    coupling.initial_inlet_blocks = coupled.blocks_at_inlets(scene, units);
    Ok((rock, coupling))
}

impl<'a> Coupled<'a> {
    pub(crate) fn new(rock: &'a Rock, coupling: &'a LatticeCoupling) -> Self {
        Self { rock, coupling }
    }

    /// Whether a block can move at all.
    pub fn moves(&self) -> bool {
        self.rock.moves()
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

    /// Number of blocks that are in the fluid, the first ones; the others are its solids and walls.
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
