//! The state of a simulation between two steps. Device arrays are in canonical order, so that a run can restart with any
//! storage, lanes or bindings.

#[cfg(feature = "checkpoint")]
mod file;

use crate::{
    Error, Result,
    coupling::{CouplingState, RockState},
    geometry::Load,
    lattice::{Inside, Populations},
    scene::Scene,
    simulation::{FlowControlState, Reading, SamplingState},
    sph::{Particle, SphState},
};
use glam::DVec3;
use std::fmt;

/// The kind of a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Blocks without a fluid.
    Rock,
    /// A fluid on a lattice, with or without blocks.
    Lattice,
    /// Free water (SPH), with or without blocks.
    Particles,
}

impl Kind {
    /// The kind of a scene.
    pub fn of(scene: &Scene) -> Self {
        if scene.has_particles() {
            Self::Particles
        } else if scene.has_fluid() {
            Self::Lattice
        } else {
            Self::Rock
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Rock => "blocks alone",
            Self::Lattice => "a fluid on a lattice",
            Self::Particles => "free water",
        })
    }
}

/// The state of a simulation between two steps.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct Checkpoint {
    /// Steps done.
    pub step: u64,
    /// Length of a step, s.
    pub time_step: f64,
    /// The blocks, if there are any.
    pub rock: Option<RockState>,
    /// The fluid, if there is one.
    pub fluid: Option<FluidState>,
}

/// The state of a fluid.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub enum FluidState {
    /// On a lattice.
    Lattice(Box<LatticeState>),
    /// Free water.
    Particles(Box<WaterState>),
}

/// The state of a fluid on a lattice.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct LatticeState {
    /// Cell size, m.
    pub cell: f64,
    /// The populations.
    pub populations: Populations,
    /// Velocities in cells with solid, on which the next step does not depend.
    pub inside: Inside,
    /// The coupling to blocks, if there are any.
    pub coupling: Option<CouplingState>,
    /// Field statistics, if the scene outputs any.
    pub sampling: Option<SamplingState>,
    /// State of the bulk velocity controller, if there is one.
    pub flow_control: Option<FlowControlState>,
}

/// The state of free water.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct WaterState {
    /// Lower corner of the domain, m.
    pub origin: DVec3,
    /// Its size, m.
    pub size: DVec3,
    /// Spacing of the particles, m.
    pub spacing: f64,
    /// The particles, in the order and the units of the device.
    #[cfg_attr(feature = "checkpoint", serde(with = "crate::gpu::plain_bytes"))]
    pub particles: Vec<Particle>,
    /// State of the solver without the particles.
    pub solver: SphState,
    /// Mean load on each block in the last exchange; empty before the first one.
    pub loads: Vec<Load>,
    /// Work of blocks since the start in joints that have no particles, J.
    pub joints: f64,
    /// Measurements of the pressure sensors.
    pub sensors: Vec<Reading>,
}

impl Checkpoint {
    /// The kind of the simulation.
    pub fn kind(&self) -> Kind {
        match self.fluid {
            None => Kind::Rock,
            Some(FluidState::Lattice(_)) => Kind::Lattice,
            Some(FluidState::Particles(_)) => Kind::Particles,
        }
    }

    /// Checks that it belongs to a simulation with the same time step, up to a relative difference besides rounding.
    ///
    /// # Errors
    /// [`Error::Argument`] if not.
    pub(super) fn check_time_step(&self, time_step: f64, difference: f64) -> Result<()> {
        let apart = (self.time_step - time_step).abs() > difference * time_step;
        if apart && differ(self.time_step, time_step) {
            return Err(other_scene(
                format!("steps of {:e} s", self.time_step),
                format!("steps of {time_step:e} s"),
            ));
        }
        Ok(())
    }
}

/// Whether two values differ by more than rounding.
pub(super) fn differ(its: f64, own: f64) -> bool {
    (its - own).abs() > 1e-12 * own
}

/// The error for a checkpoint that does not match the scene.
pub(super) fn other_scene(its: impl fmt::Display, own: impl fmt::Display) -> Error {
    Error::argument(
        "restart",
        format!(
            "the checkpoint is of {its}, and the scene of {own}; restart with the scene that wrote it"
        ),
    )
}
