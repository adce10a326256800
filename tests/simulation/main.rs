//! Whole simulations: probes, sensors and restarts.

mod flow_control;
mod hydrostatic_walls;
mod levels;
mod narrow_joints;
mod oblique_plates;
mod pressure_sensors;
mod probes;
mod sph_restart;
mod static_surfaces;
mod statistics;
mod synthetic_turbulence;
mod thin_walls;

use kit::Rig;
use riprap::{scene::Scene, simulation::probe::Gauge};
use std::collections::BTreeMap;

/// The values of the first probe of a scene at the end of its run, by the names of their columns.
fn probed_at_end(rig: &Rig, scene: &Scene) -> BTreeMap<String, f64> {
    let mut simulation = rig.simulation(scene).unwrap();
    let steps = scene.run.count(simulation.time_step());
    rig.wait(simulation.advance(steps)).unwrap();
    let gauge = Gauge::new(scene, simulation.solid(), &scene.probes[0]).unwrap();
    let read = simulation.read(gauge.fields(), gauge.cells());
    let row = gauge.rows(&rig.wait(read).unwrap()).unwrap().remove(0);
    gauge
        .columns()
        .iter()
        .map(ToString::to_string)
        .zip(row)
        .collect()
}
