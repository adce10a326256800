//! Conversion of a scene to the setups of the engines: lattice, blocks, particles.

#[cfg(feature = "rock")]
mod blocks;
mod keys;
mod lattice;
#[cfg(feature = "sph")]
mod particles;

#[cfg(feature = "rock")]
pub use blocks::{BlockSetup, DiscardedPieces, block_setup};
#[cfg(feature = "sph")]
pub(crate) use blocks::{rotation, shape};
pub(crate) use keys::lattice_key;
#[cfg(feature = "sph")]
pub(crate) use keys::particle_key;
#[cfg(feature = "rock")]
pub(crate) use keys::rock_key;
pub use lattice::{face_density, face_velocity, lattice_setup};
#[cfg(feature = "sph")]
pub(crate) use particles::scene_step;
#[cfg(feature = "sph")]
pub use particles::{boundary_particles, fill, particle_lattice, particle_setup, water_bodies};
