//! SPH: initial particles, kernels against their twins, and small flows.

mod advice;
mod boundary_particles;
mod energy;
mod fill;
mod flows;
mod gauges;
mod internal_faces;
mod mueller;
mod programs;
mod refusals;
mod start;
mod step;
mod tank;
mod twin;
mod wendland;
