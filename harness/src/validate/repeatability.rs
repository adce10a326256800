//! The same run gives the same bits: twice, after a restart, and with other workgroup shapes.

use super::{CaseContext, Outcome, fields};
use riprap::lattice::{Face, Force, Populations, Setup};

const CELLS: [u32; 3] = [24, 12, 8];
const STEPS: u64 = 41;
/// Odd, so that the restart changes the parity of the following steps.
const BREAK: u64 = 17;

/// Inlet, outflow, a moving wall, a wall at rest, a solid block, a force and WALE.
fn everything() -> Setup {
    let mut setup = Setup::periodic(CELLS, 0.005);
    let inlet = vec![[0.04, 0.0, 0.0]; 12 * 8];
    setup.faces[0] = [Face::Velocity(inlet), Face::Outflow { density: 1.0 }];
    setup.faces[1] = [Face::Wall([0.0; 3]), Face::Wall([0.02, 0.0, 0.01])];
    setup.force = Force::Constant([1e-5, 0.0, 2e-5]);
    setup.wale = Some(0.5);
    let in_block =
        |at: [f64; 3]| (8.0..12.0).contains(&at[0]) && (3.0..8.0).contains(&at[1]) && at[2] < 4.0;
    setup.solid = fields::centres(CELLS).map(in_block).collect();
    setup
}

/// Runs the case.
pub fn run(context: &CaseContext) -> Outcome {
    let start = fields::state(CELLS, |[x, y, z]| {
        let wave = |s: f64| 0.02 * (0.7 * s).sin();
        (1e-3 * wave(x + y), [0.04 + wave(y), wave(z), wave(x)])
    });
    let whole = |setup: Setup| -> anyhow::Result<_> {
        let mut flow = context.flow(setup, &start, true)?;
        flow.advance(STEPS)?;
        Ok((flow.trial(), flow.populations()?))
    };
    let (trial, first) = whole(everything())?;
    let mut records = Vec::new();
    let mut same = |quantity: &str, trial: &super::Trial, other: &Populations| {
        let bits = |p: &Populations| -> Vec<u32> {
            let all = p.values.iter().chain(&p.velocity).chain(&p.outflow_state);
            all.map(|v| v.to_bits()).collect()
        };
        let (a, b) = (bits(&first), bits(other));
        let count = a.iter().zip(&b).filter(|(a, b)| a != b).count() + a.len().abs_diff(b.len());
        records.push(trial.at_most(quantity, count as f64, 0.0));
    };
    let (_, second) = whole(everything())?;
    same("second run: bits that differ", &trial, &second);

    let mut flow = context.flow(everything(), &start, true)?;
    flow.advance(BREAK)?;
    let saved = flow.populations()?;
    let mut flow = context.resumed(everything(), &saved)?;
    flow.advance(STEPS - BREAK)?;
    let end = flow.populations()?;
    same("restart: bits that differ", &flow.trial(), &end);

    for brick in [[4, 4, 4], [64, 1, 1], [1, 8, 8]] {
        let (trial, end) = whole(fields::changed(&everything(), |s| s.brick = brick))?;
        let quantity = format!("bricks of {brick:?}: bits that differ");
        same(&quantity, &trial, &end);
    }
    let (trial, end) = whole(fields::changed(&everything(), |s| s.bindings = Some(3)))?;
    same("three bindings: bits that differ", &trial, &end);
    Ok(records)
}
