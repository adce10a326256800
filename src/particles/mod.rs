//! A fluid of particles (SPH): where they are at the start, in the water and in what holds it.
//!
//! Particles of the fluid stand on a lattice of spacing Δx. Walls and blocks carry *shell* particles inside,
//! in as many layers as the kernel reaches, the first Δx/2 below the surface (Adami, Hu & Adams 2012,
//! J. Comput. Phys. 231:7057), so that the kernel of a particle beside them finds as much to sum as one in
//! the middle of the water.

mod crowd;
mod facet;
mod fill;
mod grid;
mod kernel;
mod placed;
mod shell;
mod sphere;

pub use fill::{Start, fill};
pub use kernel::Kernel;
pub use shell::shells;
