//! Code shared by tests, benchmarks and the harness: adapter selection, a device for tests, clocks and copies, scenes of
//! any size, and the f64 twins of the kernels.

mod assert;
pub mod broadphase;
pub mod clock;
pub mod contact;
pub mod copy;
pub mod gpu;
pub mod pile;
mod random;
mod rig;
pub mod rock;
pub mod scene;
pub mod subject;
pub mod tank;
pub mod twin;

pub use assert::{assert_contains, assert_near, assert_relative};
pub use random::Random;
pub use rig::{POISON, Rig, Workbench};
