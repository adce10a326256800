//! `riprap run` and the commands that run scenes: output, ends of runs, and refusals.

mod block_shapes;
mod coupled;
mod deformable;
mod dry;
mod error_estimate;
mod fingerprint;
mod fixture;
#[cfg(unix)]
mod interrupted;
mod lattice;
mod python;
mod sph;
mod statistics;
mod threshold;
mod views;
