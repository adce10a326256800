//! Torque on a sphere that turns in a viscous fluid: 8πμr³ω/(1 − c) in a dilute periodic array.

use crate::validate::{
    Outcome, Stand,
    tank::{self, Tank, block, numbers},
};
use riprap::scene::{BlockShape, Motion};
use std::f64::consts::{PI, TAU};

/// ω r²/ν: the torque of inertia grows with its square and is 1e-4 of the whole.
const REYNOLDS: f64 = 0.3;

/// Spheres of 8 cells in 24³, and with `--full` of 16 in 48³.
pub fn run(stand: &Stand) -> Outcome {
    let mut runs = vec![(4.0, 24, 0.6, 3e-2), (4.0, 24, 1.0, 3e-2)];
    if stand.full {
        runs.extend([(8.0, 48, 0.6, 1e-2), (8.0, 48, 1.0, 1e-2)]);
    }
    let mut records = Vec::new();
    for (radius, edge, tau, limit) in runs {
        let nu = (tau - 0.5) / 3.0;
        let length = f64::from(edge);
        let omega = REYNOLDS * nu / (radius * radius);
        let mut scene = tank::scene([edge; 3], tau)?;
        let shape = BlockShape::Sphere { radius };
        let mut sphere = block(shape, [0.5 * length + 0.2; 3], Motion::Driven);
        sphere.spin = numbers([0.0, 0.0, omega]);
        scene.blocks.push(sphere);
        // The slowest wave of the box, of which the torque feels little, has died down to 0.2 %.
        let steps = (6.0 / (nu * (TAU / length).powi(2))) as u64;
        scene.coupling.interval = (steps / 8) as u32;
        let mut tank = Tank::fill(stand, &scene)?;
        tank.advance(8 * u64::from(scene.coupling.interval))?;
        let concentration = 4.0 / 3.0 * PI * (radius / length).powi(3);
        let exact = -8.0 * PI * nu * radius.powi(3) * omega / (1.0 - concentration);
        let torque = tank.load(0).flow.torque();
        let trial = tank.trial("turning sphere");
        let quantity = format!("T / (8πμr³ω/(1−c)), r = {radius}, τ = {tau}");
        records.push(trial.relative(quantity, torque.z / exact, 1.0, limit));
        let across = torque.truncate().length() / exact.abs();
        records.push(trial.at_most("torque across / torque", across, 1e-3));
    }
    Ok(records)
}
