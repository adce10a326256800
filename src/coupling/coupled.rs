//! The blocks of a scene in its lattice.

use super::{
    CouplingParams, FluidLoad, Gap, InteriorFluid, LatticeCoupling, Rock, gaps::gaps,
    inlets::BlockAtInlet, lattice_coupling::ProbeRequest, lubrication::lubrication_film,
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
#[derive(Debug)]
pub struct Coupled {
    pub(super) rock: Rock,
    pub(super) coupling: LatticeCoupling,
    /// Number of blocks in the fluid, the first ones; the others are walls and solids, which the lattice resolves itself.
    in_fluid: usize,
    /// Pairs of blocks closer than a cell at the start.
    gaps: Vec<Gap>,
    /// Whether a probe requests the loads on the faces of each block in the fluid.
    pub(super) face_probes: Vec<bool>,
    /// Blocks in inflow cells at the start.
    pub(super) initial_inlet_blocks: Vec<BlockAtInlet>,
}

impl Coupled {
    /// The blocks of a scene, as `setup` has them, in its lattice.
    ///
    /// # Errors
    /// Those of an invalid setup of blocks, and limits of the device.
    pub async fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lattice: &Lattice,
        (scene, units): (&Scene, &Units),
        setup: BlockSetup,
    ) -> Result<Self> {
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
        let mut rock = Rock::new(device, queue, scene, setup, params).await?;
        let gaps = gaps(
            &rock.setup.setup,
            &rock.blocks,
            in_fluid,
            units.cell,
            &mut rock.finder,
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
        let mut coupled = Self {
            coupling: LatticeCoupling::new(device, lattice, (scene, units), solids, period)?,
            rock,
            in_fluid,
            gaps,
            face_probes: requests.iter().map(|request| request.faces).collect(),
            initial_inlet_blocks: Vec::new(),
        };
        coupled.initial_inlet_blocks = coupled.blocks_at_inlets(scene, units);
        Ok(coupled)
    }

    /// The rock, and its coupling to the lattice.
    pub(crate) fn rock_and_coupling(&mut self) -> (&mut Rock, &mut LatticeCoupling) {
        (&mut self.rock, &mut self.coupling)
    }

    /// Whether a block can move at all.
    pub fn moves(&self) -> bool {
        self.rock.moves()
    }

    /// The load of the exterior fluid on each block at the last exchange: [`Rock::external_load`].
    pub fn external_load(&self) -> &[FluidLoad] {
        self.rock.external_load()
    }

    /// The load of the fluid on each block at the last exchange, summed over its cells: [`Rock::cell_load`].
    pub fn cell_load(&self) -> &[FluidLoad] {
        self.rock.cell_load()
    }

    /// The blocks in their present state.
    pub fn blocks(&self) -> &Blocks {
        self.rock.blocks()
    }

    /// The setup of the blocks.
    pub fn setup(&self) -> &BlockSetup {
        self.rock.setup()
    }

    /// Number of blocks that are in the fluid, the first ones; the others are its solids and walls.
    pub fn in_fluid(&self) -> usize {
        self.in_fluid
    }

    /// The pairs of blocks, at least one of them in the fluid, that were less than a cell apart at the start.
    pub fn gaps(&self) -> &[Gap] {
        &self.gaps
    }

    /// The cells of the blocks.
    pub fn solid_cells(&self) -> &SolidCells {
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
