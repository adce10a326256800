//! Free water: smoothed particles (SPH), with walls and blocks in it.
//!
//! Where they are at the start, the host says ([`fill`], [`shells`]): particles of the fluid stand on a lattice
//! of spacing Δx. Walls and blocks carry *shell* particles inside, in as many layers as the kernel reaches, the
//! first Δx/2 below the surface (Adami, Hu & Adams 2012, J. Comput. Phys. 231:7057), so that the kernel of a
//! particle beside them finds as much to sum as one in the middle of the water. From there on they are on the
//! device ([`Particles`]).

mod advise;
mod asked;
mod check;
mod cloud;
mod crowd;
mod edge;
mod facet;
mod fill;
mod followed;
mod frame;
mod from_scene;
mod gaps;
mod gauges;
mod hulls;
mod kernel;
mod kernels;
mod lattice;
mod layout;
mod loads;
mod near;
#[allow(clippy::module_inception)]
mod particles;
mod placed;
mod program;
mod setup;
mod shell;
mod solid;
mod sorting;
mod speeds;
mod sphere;
mod standing;
mod state;
mod totals;
mod water;
mod works;

pub use advise::advise;
pub use cloud::cloud;
pub use fill::{Start, fill};
pub use frame::Frame;
pub use from_scene::particle_setup;
pub use gauges::Gauges;
pub use kernel::Kernel;
pub use kernels::Numbers;
pub use layout::{Clock, Home, Hull, Motion, Particle, Shelter};
pub use particles::{Exchange, Particles};
pub use program::{KERNELS, MOST_BINDINGS, constants, program};
pub use setup::{Body, Neighbours, Scheme, Setup, Side, StateEquation};
pub use shell::shells;
pub use solid::{Faces, Solid};
pub use sorting::{Sorted, Sorting};
pub use state::State;
pub use totals::Totals;
pub use water::Water;
pub use works::Works;
