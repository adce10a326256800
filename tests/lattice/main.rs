//! The lattice: kernels against their f64 twin and exact solutions, limits of devices, and equal bits in every layout.

mod closed_joint;
mod divergence_guard;
mod force;
mod kernels;
mod limits;
mod refusals;
mod reproducibility;
mod rows;
mod statistics;
mod surface;
mod synthetic_turbulence;
mod twin;
mod wall_model;
