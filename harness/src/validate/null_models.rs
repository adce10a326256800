//! A model with its constant at zero is the simpler model.

use super::{
    Outcome, Stand,
    fields::changed,
    golden::{noise_and_shear, suga, with_own_velocity},
};
use kit::twin::lattice::W;
use riprap::lattice::{Collision, Equilibrium, Force, Populations, Rates, Setup};

const CELLS: [u32; 3] = [24, 10, 8];
/// Two orders of the same sums differ by f32 round-off, some 1e-7 of what is summed; the
/// populations differ from their weights by some 0.1.
const LIMIT: f64 = 1e-6;
const STEPS: u64 = 50;

/// Runs the case.
pub fn run(stand: &Stand) -> Outcome {
    let base = Setup::periodic(CELLS, (1.0 / 1.9 - 0.5) / 3.0);
    let bgk = changed(&base, |s| s.collision = Collision::Bgk);
    let equal = |collision| {
        changed(&base, |s| {
            (s.collision, s.rates) = (collision, Rates::equal(1.0 / s.tau()));
        })
    };
    let second = |setup: &Setup| changed(setup, |s| s.equilibrium = Equilibrium::SecondOrder);
    let null_wale = |setup: &Setup| changed(setup, |s| s.wale = Some(0.0));
    let null_force = changed(&base, |s| s.force = Force::Constant([0.0; 3]));
    let listed = changed(&base, |s| s.solid = vec![false; 24 * 10 * 8]);
    let four = changed(&base, |s| s.lanes = 4);
    let [hermite, suga_equal] = [Collision::Hermite, Collision::Suga].map(equal);
    let suga = suga(CELLS);
    let wale = "WALE with C_w = 0 - laminar";
    let pairs = [
        (wale, null_wale(&base), base.clone()),
        (wale, null_wale(&suga), suga),
        ("F = 0 - no force", null_force, base.clone()),
        ("equal rates - BGK", hermite, bgk.clone()),
        ("equal rates - BGK", suga_equal.clone(), bgk.clone()),
        ("equal rates - BGK", second(&suga_equal), second(&bgk)),
        ("listed bricks - all bricks", listed, base.clone()),
        ("four lanes - one lane", four, base.clone()),
    ];
    let mut records = Vec::new();
    for (name, setup, simpler) in pairs {
        let (trial, a) = end(stand, setup, STEPS)?;
        let (_, b) = end(stand, simpler, STEPS)?;
        let quantity = format!("{name}: largest Δf/w");
        records.push(trial.at_most(quantity, difference(&a, &b, |_| true), LIMIT));
    }
    for lanes in [1, 4] {
        records.push(flagged(stand, &base, lanes)?);
    }
    Ok(records)
}

fn end(stand: &Stand, setup: Setup, steps: u64) -> anyhow::Result<(super::Trial, Populations)> {
    let mut flow = stand.resumed(setup, &with_own_velocity(noise_and_shear(CELLS)))?;
    flow.advance(steps)?;
    Ok((flow.trial(), flow.populations()?))
}

/// One solid cell turns its bricks into flagged ones. Nothing of it reaches farther than one cell a
/// step: beyond that the flagged kernel is the plain one.
fn flagged(stand: &Stand, base: &Setup, lanes: u32) -> anyhow::Result<super::Record> {
    let steps = 3;
    let setup = changed(base, |s| s.lanes = lanes);
    let with_cell = changed(&setup, |s| {
        s.solid = (0..24 * 10 * 8).map(|n| n == 0).collect()
    });
    let (trial, a) = end(stand, with_cell, steps)?;
    let (_, b) = end(stand, setup, steps)?;
    let reached = |x: usize| x.min(24 - x) as u64 <= steps + 1;
    let error = difference(&a, &b, |cell| !reached(cell % 24));
    Ok(trial.at_most("flagged cells - plain cells: largest Δf/w", error, LIMIT))
}

/// Largest difference of a population over its weight in the cells that count.
fn difference(a: &Populations, b: &Populations, counts: impl Fn(usize) -> bool) -> f64 {
    let n = a.values.len() / 27;
    let pairs = a.values.iter().zip(&b.values).enumerate();
    pairs
        .filter(|(at, _)| counts(at % n))
        .map(|(at, (a, b))| f64::from((a - b).abs()) / W[at / n])
        .fold(0.0, f64::max)
}
