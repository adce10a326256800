//! Free water: smoothed particles (SPH) on the device, with walls and blocks in it.

mod frame;
mod kernels;
mod layout;
#[allow(clippy::module_inception)]
mod particles;
mod program;
mod setup;
mod sorting;
mod water;

pub use frame::Grid;
pub use kernels::Numbers;
pub use layout::{Clock, Home, Motion, Particle};
pub use particles::{Exchange, Particles, State};
pub use program::{KERNELS, MOST_BINDINGS, constants, program};
pub use setup::{Body, Setup, Side, StateEquation};
pub use sorting::{Sorted, Sorting};
pub use water::Water;
