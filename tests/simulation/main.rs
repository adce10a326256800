//! Whole simulations: probes, sensors and restarts.

mod pressure_sensors;
mod probes;
mod sph_restart;
mod statistics;
