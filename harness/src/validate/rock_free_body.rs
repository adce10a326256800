//! Free rotation of an asymmetric body: I = (1, 2, 3) kg m², ω₀ = (0.1, 1, 0.05) rad/s.

use super::{Outcome, Stand, Trial};
use glam::{DMat3, DQuat, DVec3};
use riprap::rock::integrate::{Principal, spin, turn};
use std::time::Instant;

const START: DVec3 = DVec3::new(0.1, 1.0, 0.05);
/// ω(50 s) in the body's frame, from the elliptic functions.
const END: DVec3 = DVec3::new(0.1032592, -0.99966871, 0.05216149);

struct Spun {
    trial: Trial,
    omega: DVec3,
    energy: f64,
    momentum: f64,
}

fn spun(steps: u32, dt: f64) -> Spun {
    let begin = Instant::now();
    let body = Principal::of(DMat3::from_diagonal(DVec3::new(1.0, 2.0, 3.0)));
    let momentum = START * body.moments;
    let energy = |omega: DVec3| 0.5 * omega.dot(momentum);
    let mut rotation = DQuat::IDENTITY;
    let (mut worst, mut off): (f64, f64) = (0.0, 0.0);
    for _ in 0..steps {
        rotation = turn(&body, rotation, momentum, dt);
        let omega = spin(&body, rotation, momentum);
        worst = worst.max((energy(omega) / energy(START) - 1.0).abs());
        let found = rotation * (body.moments * (rotation.conjugate() * omega));
        off = off.max((found - momentum).length());
    }
    Spun {
        trial: Trial {
            setup: format!("h = {dt} s"),
            cells: 1,
            steps: steps.into(),
            seconds: begin.elapsed().as_secs_f64(),
            ..Trial::default()
        },
        omega: rotation.conjugate() * spin(&body, rotation, momentum),
        energy: worst,
        momentum: off,
    }
}

/// Order, bound of the energy over 4·10⁴ steps, angular momentum.
pub fn run(_: &Stand) -> Outcome {
    let mut records = Vec::new();
    let mut errors = Vec::new();
    for dt in [0.1, 0.05, 0.025] {
        let run = spun((50.0 / dt) as u32, dt);
        let error = (run.omega - END).length();
        records.push(run.trial.report("error of ω(50 s), rad/s", error, None));
        errors.push(error);
        if errors.len() > 1 {
            let order = (errors[errors.len() - 2] / error).log2();
            records.push(run.trial.absolute("order", order, 2.0, 0.1));
        }
    }
    let (early, late) = (spun(1000, 0.05), spun(40_000, 0.05));
    let growth = late.energy / early.energy;
    let trial = &late.trial;
    records.push(trial.at_most("largest error of the energy / energy", late.energy, 2e-5));
    records.push(trial.absolute("that over 4e4 steps / over 1e3", growth, 1.0, 0.01));
    // What turning a vector of length 2 to the body's axes and back rounds.
    records.push(trial.at_most("largest |ΔL|, kg m²/s", late.momentum, 1e-14));
    Ok(records)
}
