//! Blocks that move: their poses, their loads, and the step of all of them.
//!
//! [`Blocks`] owns the state. A step is kick, drift, the contacts of the candidate pairs, kick; which pairs
//! are candidates says a [`Broadphase`](crate::rock::broadphase::Broadphase) of the caller's. Forces are summed
//! in the order of the pairs, so that the bits do not depend on the number of threads.

pub mod broadphase;
pub mod contact;
pub mod integrate;
pub mod law;

mod applied_forces;
mod blocks;
mod body;
mod bonds;
mod candidate_pairs;
mod check;
mod contact_list;
mod deforming;
mod energy;
mod films;
mod narrowphase;
mod period;
mod placed_parts;
mod relax;
mod resolver_pool;
mod setup;
mod sleep;
mod snapshot;
mod step;
mod stress;
mod time_step;
mod tunnelling;

pub use blocks::Blocks;
pub use contact_list::ContactPoint;
pub use energy::EnergyLedger;
pub use period::Period;
pub use setup::{
    Block, Deformable, FixedPoint, Guide, Material, Motion, PairMaterial, PointLoad, Setup, Sleep,
};
pub use snapshot::Snapshot;
pub use step::StepTimes;

use body::Body;
