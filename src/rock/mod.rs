//! Moving blocks: poses, loads, contacts and time integration.
//!
//! [`Blocks`] owns the state. A step is kick, drift, the contacts of the candidate pairs, kick. The caller provides a
//! [`Broadphase`](crate::rock::broadphase::Broadphase), which finds the candidate pairs. Forces are summed
//! in the order of the pairs, so that the bits do not depend on the number of threads.
//!
//! ```
//! use glam::DVec3;
//! use riprap::{
//!     geometry::{Polyhedron, Shape},
//!     rock::{Block, Blocks, Material, Setup, broadphase::HostBroadphase},
//! };
//! use std::sync::Arc;
//!
//! # fn main() -> riprap::Result<()> {
//! // A cube of 1 m on a floor, under gravity.
//! let floor = Polyhedron::cuboid(DVec3::new(4.0, 4.0, 0.2))?;
//! let cube = Arc::new(Shape::from(Polyhedron::cuboid(DVec3::ONE)?));
//! let mut blocks = Blocks::new(Setup {
//!     blocks: vec![
//!         Block::new("floor", Shape::from(floor), DVec3::Z * -0.1).fixed(),
//!         Block::new("cube", cube, DVec3::Z * 0.5),
//!     ],
//!     materials: vec![Material::default()],
//!     ..Setup::default()
//! })?;
//! // No device is needed: the pairs are found on the host.
//! pollster::block_on(blocks.advance(&mut HostBroadphase, 0.05))?;
//! assert!((blocks.poses()[1].centre.z - 0.5).abs() < 1e-3);
//! # Ok(())
//! # }
//! ```

pub mod broadphase;
pub mod contact;
pub mod integrate;
pub mod law;

mod blocks;
mod body;
mod candidate_pairs;
mod check;
mod contact_list;
mod damping;
mod deforming;
mod energy;
mod films;
mod narrowphase;
mod period;
mod relax;
mod resolver_pool;
mod seams;
mod setup;
mod snapshot;
mod step;
mod threads;
mod time_step;

pub use blocks::Blocks;
pub use contact_list::ContactPoint;
pub use energy::EnergyLedger;
pub use period::Period;
pub(crate) use period::Periods;
pub use setup::{
    Block, Deformable, FixedPoint, Guide, Material, Motion, PairMaterial, PointLoad, Setup, Sleep,
};
pub use snapshot::Snapshot;
pub use step::StepTimes;

use body::Body;
pub(crate) use body::formula_values;
