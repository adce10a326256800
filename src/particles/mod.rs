//! A fluid of particles (SPH): where they are at the start, in the water and in what holds it, and how they
//! move on the device.
//!
//! Particles of the fluid stand on a lattice of spacing Δx. Walls and blocks carry *shell* particles inside,
//! in as many layers as the kernel reaches, the first Δx/2 below the surface (Adami, Hu & Adams 2012,
//! J. Comput. Phys. 231:7057), so that the kernel of a particle beside them finds as much to sum as one in
//! the middle of the water.

mod crowd;
mod facet;
mod fill;
mod frame;
mod from_scene;
mod grid;
mod hulls;
mod kernel;
mod kernels;
mod layout;
mod near;
#[allow(clippy::module_inception)]
mod particles;
mod placed;
mod program;
mod setup;
mod shell;
mod sorting;
mod sphere;
mod water;

pub use fill::{Start, fill};
pub use frame::Frame;
pub use from_scene::particle_setup;
pub use kernel::Kernel;
pub use kernels::Numbers;
pub use layout::{Clock, Home, Hull, Motion, Particle};
pub use particles::{Exchange, Particles, State};
pub use program::{KERNELS, MOST_BINDINGS, constants, program};
pub use setup::{Body, Neighbours, Scheme, Setup, Side, StateEquation};
pub use shell::shells;
pub use sorting::{Sorted, Sorting};
pub use water::Water;
