//! From a scene to the setups of the engines: lattice, blocks, particles.

mod blocks;
mod lattice;

pub use blocks::{BlockSetup, LeftOut, block_setup};
pub(crate) use blocks::{rotation, shape};
pub use lattice::{face_velocity, lattice_setup};

pub use crate::sph::particle_setup;
