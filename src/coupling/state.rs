//! The state of blocks, and of their coupling to a lattice, between two steps.

use super::{FluidLoad, InteriorInertia, LatticeCoupling, LoadAverage, Rock};
use crate::{Error, Result, geometry::Pose, rock::Snapshot};

/// The state of the blocks of a scene, without their fluid: everything on which their next steps depend.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct RockState {
    /// The blocks.
    pub snapshot: Snapshot,
    /// Of the fluid inside each block; empty without a fluid.
    interior: Vec<InteriorInertia>,
    /// Load on each block in the last exchange; empty without a fluid.
    cell_load: Vec<FluidLoad>,
    /// Work of the blocks on the fluid since the start, J.
    work_on_fluid: f64,
}

/// The state of the coupling of blocks to a lattice.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct CouplingState {
    load_average: LoadAverage,
    /// Pose of the last tile search of each block in the fluid: the tiles determine the order of summation, and so the
    /// rounding of loads.
    tiled: Vec<Option<Pose>>,
}

impl Rock {
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
    /// [`Error::Argument`] if it is of other blocks.
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

impl LatticeCoupling {
    /// The present state, for a later [`LatticeCoupling::restore`]; waits for the loads in flight.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn state(&mut self) -> Result<CouplingState> {
        self.read_loads().await?;
        Ok(CouplingState {
            load_average: self.load_average.clone(),
            tiled: self.cells.tiled(),
        })
    }

    /// Checks that a state is of as many blocks in the fluid.
    ///
    /// # Errors
    /// [`Error::Argument`] if not.
    pub fn check(&self, state: &CouplingState) -> Result<()> {
        let known = |loads: usize| loads == 0 || loads == self.in_fluid;
        let last = state.load_average.last.as_ref();
        if state.tiled.len() == self.in_fluid
            && known(state.load_average.sum.len())
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
        self.face_loads.clear();
        self.load_average.clone_from(&state.load_average);
        self.cells.tile(&state.tiled);
        self.placed = None;
    }
}
