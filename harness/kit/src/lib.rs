//! What tests, benches and the harness share: the choice of an adapter, a device for tests, clocks and copies, scenes of
//! any size, and the f64 twins of the kernels.

pub mod broadphase;
pub mod clock;
pub mod contact;
pub mod copy;
pub mod gpu;
pub mod pile;
mod rig;
pub mod scene;
pub mod subject;
pub mod tank;
pub mod twin;

pub use rig::{POISON, Rig, Workbench};
