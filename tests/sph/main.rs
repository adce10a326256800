//! SPH: initial particles, kernels against their twins, and small flows.

mod advice;
mod boundary_particles;
mod containment;
mod energy;
mod fill;
mod gauges;
mod internal_faces;
mod mueller;
mod penalty;
mod planar;
mod programs;
mod refusals;
mod restart;
mod start;
mod step;
mod still_water;
mod tank;
mod twin;
mod wendland;
