//! Galilean invariance: a shear wave that is carried along an axis decays as one at rest.

use super::{Outcome, Stand, fields};
use riprap::lattice::Equilibrium;
use std::f64::consts::TAU;

const N: u32 = 64;
const NU: f64 = 0.01;
/// Amplitude of the wave: far above f32 round-off, far below the speed that carries it.
const AMPLITUDE: f64 = 0.005;
/// Times that the wave crosses the box.
const CROSSINGS: f64 = 8.0;
/// Of the viscosity.
const LIMIT: f64 = 1e-3;

/// Runs the case.
pub fn run(stand: &Stand) -> Outcome {
    // With the equilibrium of order 2 the viscosity falls as 1 − 3U² (Qian & Orszag 1993).
    let runs = [
        (Equilibrium::Product, 0.0, 1.0, Some(LIMIT)),
        (Equilibrium::Product, 0.1, 1.0, Some(LIMIT)),
        (Equilibrium::Product, 0.2, 1.0, Some(LIMIT)),
        (Equilibrium::SecondOrder, 0.1, 0.97, None),
        (Equilibrium::SecondOrder, 0.2, 0.88, None),
    ];
    let mut records = Vec::new();
    for (equilibrium, speed, expected, limit) in runs {
        let cells = [N, 4, 4];
        let mut setup = stand.setup(cells, NU);
        setup.equilibrium = equilibrium;
        let k = TAU / f64::from(N);
        let start = fields::state(cells, |[x, _, _]| {
            (0.0, [speed, AMPLITUDE * (k * x).sin(), 0.0])
        });
        let mut flow = stand.flow(setup, &start, true)?;
        // Whole crossings at both speeds, so that a wave that is not quite one is weighed alike.
        let steps = CROSSINGS / 2.0 * f64::from(N) / 0.1;
        let mut size = || -> anyhow::Result<f64> {
            flow.advance(steps as u64)?;
            let state = flow.state()?;
            let part = |wave: fn(f64) -> f64| {
                fields::amplitude(cells, &state, |[x, _, _]| [0.0, wave(k * x), 0.0])
            };
            Ok(part(f64::sin).hypot(part(f64::cos)))
        };
        let ratio = size()? / size()?;
        let nu = ratio.ln() / (k * k * steps);
        let trial = flow.trial();
        let quantity = format!("viscosity / nominal, U = {speed}");
        records.push(trial.relative(quantity, nu / NU, expected, limit));
    }
    Ok(records)
}
