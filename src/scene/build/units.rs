//! The lattice units of a scene.

use crate::{
    Error, Result,
    scene::{Numerics, Scene},
    units::{SOUND_SPEED_SQUARED, Units},
};

impl Units {
    /// The units of `scene`: its `time_step`, or Δt = Ma Δx/(√3 U) from its Mach number and
    /// velocity scale.
    ///
    /// # Errors
    /// If the scene gives neither a time step nor any velocity from which one follows.
    pub fn of(scene: &Scene) -> Result<Self> {
        if scene.has_particles() {
            return Err(Error::scene(
                "particles",
                "a fluid of particles has no lattice; run it as one of particles",
            ));
        }
        let cell = scene.domain.cell;
        let time_step = match scene.numerics.time_step {
            Some(time_step) => time_step,
            None => {
                let mach = scene.numerics.mach.unwrap_or(Numerics::DEFAULT_MACH);
                mach * cell * SOUND_SPEED_SQUARED.sqrt() / scene.velocity_scale()?
            }
        };
        Ok(Self {
            cell,
            time_step,
            density: scene.fluid.density,
        })
    }
}
