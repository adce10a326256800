//! Blocks and a fluid together (Gardner & Sitar 2018, section 4): poses in, loads out.
//!
//! [`run`] is the coupling loop for any [`Fluid`]. [`Rock`] holds the blocks of a scene, requests an exchange interval from
//! the fluid, and advances the blocks under the loads of each exchange, in as many sub-steps as their contacts need.
//! [`Coupled`] adds the cells of the blocks in a lattice ([`crate::psm`]). The lattice runs the bricks that contain blocks
//! first, so that their loads are read while the other bricks run.
//!
//! Joints that the fluid does not resolve carry uplift. In a lattice, `uplift` fits the pressure in closed joints to the wet
//! faces at their rims. In SPH water, `joint_seal` does so: `joint_rim` samples the rims, fits the pressure field to
//! them and propagates it to blocks without a rim, and `kernel_deficit` computes the part of the pressure that the
//! particles miss. `joint_faces` serves both fluids: neighbours over a face, and the area that they cover.
//!
//! Programs with their own blocks can use the parts separately: [`Ambient`] computes the buoyancy of a block and the weight of
//! the fluid that moves with it, [`AddedMass`] bounds the added mass, and [`InteriorInertia`] returns the inertia of the fluid
//! inside the block.
//!
//! ```
//! use glam::DVec3;
//! use riprap::{coupling::Ambient, formula::Formula, geometry::Load};
//!
//! // A block of one cubic metre in water at rest, with pressures relative to the hydrostatic pressure.
//! let gravity = DVec3::new(0.0, 0.0, -9.81);
//! let ambient = Ambient {
//!     density: 1000.0,
//!     acceleration: std::array::from_fn(|_| Formula::number(0.0)),
//!     gravity,
//!     period: None,
//! };
//! let load = Load { missing: 1.0, ..Load::default() };
//! assert_eq!(ambient.buoyancy(&load).force, -1000.0 * gravity);
//! ```

mod added_mass;
mod advice;
mod async_readback;
mod coupled;
mod exchange;
mod fluid_load;
mod gaps;
mod joint_faces;
mod joint_rim;
mod joint_seal;
mod kernel_deficit;
mod lattice_coupling;
mod particle_advice;
mod pressure_plane;
mod rock;
mod strain_load;
mod uplift;

pub use added_mass::{AddedMass, InteriorInertia, MassProperties};
pub use async_readback::{AsyncReadback, Copied};
pub(crate) use coupled::couple;
pub use coupled::{BlockCell, Coupled, Exchanges};
pub use exchange::{ExchangeInterval, Fluid, run};
pub(crate) use exchange::{check_substep_count, longest_exchange, rock_step};
pub use fluid_load::{Ambient, FluidLoad, LoadAverage};
pub use gaps::Gap;
pub(crate) use joint_seal::JointSeal;
pub use lattice_coupling::CouplingState;
pub(crate) use lattice_coupling::LatticeCoupling;
pub use particle_advice::particle_advice;
pub use rock::{CouplingParams, InteriorFluid, Rock, RockState};
pub use uplift::JointLoad;
