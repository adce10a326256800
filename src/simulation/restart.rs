//! The state of a simulation, and its restart.

use super::{
    Fluid, Kind, Simulation,
    checkpoint::{Checkpoint, FluidState, other_scene},
};
use crate::{Result, coupling::Rock};

/// Relative difference up to which a scene without a lattice takes over the step of a checkpoint.
const SIMILAR: f64 = 0.1;

impl Simulation {
    /// The present state, for a later [`Simulation::restore`].
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn checkpoint(&mut self) -> Result<Checkpoint> {
        // The coupling of a lattice waits for loads in flight, so the fluid is read before the blocks.
        let fluid = match &mut self.fluid {
            Some(Fluid::Lattice(fluid)) => Some(FluidState::Lattice(fluid.state().await?.into())),
            Some(Fluid::Particles(fluid)) => {
                let state = fluid.state(&self.scene).await?;
                Some(FluidState::Particles(Box::new(state)))
            }
            None => None,
        };
        Ok(Checkpoint {
            step: self.step(),
            time_step: self.time_step,
            rock: self.rock.as_ref().map(Rock::state),
            fluid,
        })
    }

    /// Restores a checkpoint of the same scene: the next steps are bit-identical to the steps of the run that wrote it. A scene
    /// without a lattice that differs in its duration takes over the step of the checkpoint, if it is similar.
    ///
    /// # Errors
    /// [`Error::Argument`](crate::Error::Argument) if it has another kind, time step, grid, or number of particles or blocks.
    pub fn restore(&mut self, checkpoint: &Checkpoint) -> Result<()> {
        // Everything is checked before the first change. The time step is checked last: it follows from the rest.
        match (&self.fluid, &checkpoint.fluid) {
            (Some(Fluid::Lattice(fluid)), Some(FluidState::Lattice(state))) => {
                fluid.check_state(state)?;
            }
            (Some(Fluid::Particles(fluid)), Some(FluidState::Particles(state))) => {
                fluid.check_state(&self.scene, state)?;
            }
            (None, None) => {}
            _ => return Err(other_scene(checkpoint.kind(), self.kind())),
        }
        // The step of a lattice follows from its units; that of other scenes divides the duration of the run, which may change.
        let is_lattice = self.kind() == Kind::Lattice;
        checkpoint.check_time_step(self.time_step, if is_lattice { 0.0 } else { SIMILAR })?;
        match (&mut self.rock, &checkpoint.rock) {
            (Some(rock), Some(state)) => rock.restore(state)?,
            (None, None) => {}
            (Some(_), None) => return Err(other_scene("no blocks", "blocks")),
            (None, Some(_)) => return Err(other_scene("blocks", "no blocks")),
        }
        match (&mut self.fluid, &checkpoint.fluid) {
            (Some(Fluid::Lattice(fluid)), Some(FluidState::Lattice(state))) => {
                fluid.restore(state)?;
            }
            (Some(Fluid::Particles(fluid)), Some(FluidState::Particles(state))) => {
                fluid.restore(state)?;
            }
            _ => {}
        }
        self.step = checkpoint.step;
        if !is_lattice {
            self.time_step = checkpoint.time_step;
        }
        Ok(())
    }
}
