//! Blocks that move: their poses, their loads, and the step of all of them.
//!
//! [`Blocks`] owns the state. A step is kick, drift, the contacts of the candidate pairs, kick; which pairs
//! are candidates says a [`Broadphase`](crate::rock::broadphase::Broadphase) of the caller's. Forces are summed
//! in the order of the pairs, so that the bits do not depend on the number of threads.

pub mod broadphase;
pub mod contact;
pub mod integrate;
pub mod law;

mod acting;
mod blocks;
mod body;
mod bonds;
mod books;
mod bound;
mod check;
mod contact_point;
mod deforming;
mod films;
mod items;
mod leaps;
mod ledger;
mod make;
mod narrow;
mod pairs;
mod parts;
mod period;
mod relax;
mod resolvers;
mod setup;
mod sleeping;
mod snapshot;
mod step;
mod stress;
mod sums;
mod touch;
mod touches;

pub use blocks::Blocks;
pub use contact_point::ContactPoint;
pub use ledger::Ledger;
pub use period::Period;
pub use setup::{
    Block, Deformable, FixedPoint, Guide, Material, Motion, PairMaterial, PointLoad, Setup, Sleep,
};
pub use snapshot::Snapshot;

use body::Body;
