//! From a scene to the setups of the engines: lattice, blocks, particles.

mod blocks;
mod lattice;
mod particle_step;
mod particles;
mod units;

pub use blocks::{BlockSetup, LeftOut, block_setup};
pub(crate) use blocks::{rotation, shape};
pub use lattice::{face_velocity, lattice_setup};

pub(crate) use particle_step::scene_step;
pub use particles::{boundary_particles, fill, particle_lattice, particle_setup, water_bodies};
