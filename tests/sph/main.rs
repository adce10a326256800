//! Particles of water: kernels against their twins, and small flows.

#[path = "../rig/mod.rs"]
mod rig;

mod energy;
mod held;
mod mueller;
mod plane;
mod programs;
mod push;
mod refusals;
mod restored;
mod step;
mod still;
mod tank;
mod twin;
