//! Whole simulations: probes, sensors and restarts.

mod flow_control;
mod hydrostatic_walls;
mod levels;
mod pressure_sensors;
mod probes;
mod sph_restart;
mod static_surfaces;
mod statistics;
mod synthetic_turbulence;
