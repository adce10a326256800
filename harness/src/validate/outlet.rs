//! What an outlet returns of sound that reaches it.

use super::{Outcome, Stand, fields};
use riprap::lattice::Face;

const LENGTH: u32 = 200;
/// Of the density.
const PULSE: f64 = 1e-3;
/// Standard deviation of the pulse, cells: a tenth of the domain from flank to flank.
const WIDTH: f64 = 8.0;
/// The pulse starts in the middle; after this it would be back at a third of the way.
const STEPS: u64 = 300;
const LIMIT: f64 = 0.02;

/// A pulse of density 1e-3 that runs into the outlet, in fluid at rest and in a stream.
pub fn pulse(stand: &Stand) -> Outcome {
    let mut records = Vec::new();
    for speed in [0.0, 0.05, 0.1] {
        let outlet = Face::Outflow { density: 1.0 };
        let (trial, returned) = send(stand, speed, outlet)?;
        let quantity = format!("outflow: returned amplitude, U = {speed}");
        records.push(trial.at_most(quantity, returned, LIMIT));
    }
    let (trial, returned) = send(stand, 0.0, Face::Pressure { density: 1.0 })?;
    let quantity = "pressure: returned amplitude, U = 0";
    records.push(trial.report(quantity, returned));
    Ok(records)
}

fn send(stand: &Stand, speed: f64, outlet: Face) -> anyhow::Result<(super::Trial, f64)> {
    let cells = [LENGTH, 4, 4];
    let mut setup = stand.setup(cells, 1e-3);
    setup.faces[0] = [Face::Velocity(vec![[speed as f32, 0.0, 0.0]; 16]), outlet];
    let start = fields::state(cells, |[x, _, _]| {
        let distance = (x - 0.5 * f64::from(LENGTH)) / WIDTH;
        let excess = PULSE * (-0.5 * distance * distance).exp();
        // A wave that only runs towards x: u' = c_s ρ'/ρ.
        let sound = excess / (3f64.sqrt() * (1.0 + excess));
        (excess, [speed + sound, 0.0, 0.0])
    });
    let mut flow = stand.flow(setup, &start, true)?;
    flow.advance(STEPS)?;
    let largest = flow
        .state()?
        .excess
        .iter()
        .fold(0f32, |a, b| a.max(b.abs()));
    Ok((flow.trial(), f64::from(largest) / PULSE))
}
