//! Blocks and a fluid together (Gardner & Sitar 2018, section 4): poses in, loads out.
//!
//! [`Coupled`] holds the blocks of a scene and their cells in the lattice. A step puts the blocks where they
//! are, has the fluid run the bricks that they reach, reads the loads back while the rest of the fluid runs,
//! and moves the blocks to the end of the step in as many sub-steps as their contacts want.

mod advice;
mod coupled;
mod faces;
mod film;
mod gaps;
mod gathered;
mod inlets;
mod inner_fluid;
mod joints;
mod loads;
mod near;
mod reading;
mod state;

pub use coupled::{Coupled, Exchanges, Felt};
pub use gaps::Gap;
pub(crate) use gaps::gaps;
pub use gathered::Gathered;
pub use inner_fluid::{InnerFluid, Matter};
pub use loads::Ambient;
pub use near::BlockCell;
pub use reading::Reading;
pub use state::CoupledState;
