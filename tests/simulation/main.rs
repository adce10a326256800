//! Whole simulations: probes, sensors and restarts.

mod levels;
mod pressure_sensors;
mod probes;
mod sph_restart;
mod statistics;
