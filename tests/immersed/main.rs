//! The kernels of immersed blocks against the formulas in f64.

mod exact;
mod faces;
mod layout;
mod programs;
mod reduce;
#[path = "../rig/mod.rs"]
mod rig;
mod saturate;
mod shapes;
mod tiling;
mod voxelise;
#[path = "../broadphase/workbench.rs"]
mod workbench;
