//! The types that most programs use: `use riprap::prelude::*`.
//!
//! The setups of the engines have the same name and stay in their modules, which are here as well: `lattice::Setup`,
//! `rock::Setup`, `sph::Setup`.
//!
//! ```
//! use riprap::prelude::*;
//!
//! # fn main() -> riprap::Result<()> {
//! let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
//! let mut lattice = Lattice::new(&device, lattice::Setup::periodic([16; 3], 0.01))?;
//! lattice.start(&device, &queue, &State::rest(16 * 16 * 16), true)?;
//! # Ok(())
//! # }
//! ```

pub use crate::{
    Error, Result,
    geometry::{Load, Polyhedron, Pose, Shape},
    glam::{DQuat, DVec3},
    lattice::{self, Lattice, Observer, State},
    psm::{self, SolidBlock, SolidCells},
    units::Units,
    wgpu,
};

#[cfg(feature = "rock")]
pub use crate::{
    geometry::{JointSet, RockMass},
    rock::{
        self, Block, Blocks, Material, Motion,
        broadphase::{AutoBroadphase, Broadphase, HostBroadphase},
    },
};

#[cfg(feature = "sph")]
pub use crate::sph::{self, SphSolver};

#[cfg(feature = "scene")]
pub use crate::scene::{self, Scene};

#[cfg(all(feature = "rock", feature = "sph", feature = "scene"))]
pub use crate::simulation::{self, Simulation};
