//! Blocks and a fluid together (Gardner & Sitar 2018, section 4): poses in, loads out.
//!
//! [`run`] is the loop, for any [`Fluid`]: poses in, loads out. [`Rock`] holds the blocks of a scene, tells the fluid where
//! they are and how often they want to meet it, and moves them under what they felt, in as many sub-steps as their
//! contacts want. [`Coupled`] has their cells in a lattice besides, whose fluid runs the bricks that they reach first, and
//! the rest while their loads are read.
//!
//! Joints that hold no fluid to compute have files of their own. In the lattice, `joints` tells which faces are in one and
//! `closed` what its water does, from the wet faces around it. Among particles, `sealed` does both: `rim` finds where a
//! joint ends, `head` continues the pressure from there, `passed_on` carries it through a mass of blocks, and `across`
//! is what particles themselves leave to do. `over` serves both: what lies over a face.

mod across;
mod advice;
mod closed;
mod coupled;
mod faces;
mod film;
mod fluid;
mod gaps;
mod gathered;
mod head;
mod impedance;
mod inlets;
mod inner_fluid;
mod joints;
mod loads;
mod near;
mod over;
mod passed_on;
mod reading;
mod rim;
mod rock;
mod sealed;
mod state;
mod wet;

pub use closed::JointLoad;
pub use coupled::{Coupled, Exchanges};
pub use fluid::{Fluid, Pace, run};
pub use gaps::Gap;
pub(crate) use gaps::gaps;
pub use gathered::Gathered;
pub(crate) use impedance::longest_exchange;
pub use inner_fluid::{Around, InnerFluid, Matter};
pub use loads::Ambient;
pub use near::BlockCell;
pub use reading::Reading;
pub use rock::{Company, Felt, Inside, Rock};
pub(crate) use sealed::Sealed;
pub use state::CoupledState;
pub(crate) use wet::Wet;
