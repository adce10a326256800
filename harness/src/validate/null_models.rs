//! A model with its constant at zero is the simpler model.

use super::{
    Outcome, Stand,
    fields::weight,
    golden::{noise_and_shear, suga, with_own_velocity},
};
use riprap::lattice::{Collision, Equilibrium, Force, Populations, Rates, Setup};

const CELLS: [u32; 3] = [24, 10, 8];
/// Two orders of the same sums differ by f32 round-off, some 1e-7 of what is summed; the
/// populations differ from their weights by some 0.1.
const LIMIT: f64 = 1e-6;
const STEPS: u64 = 50;

/// Runs the case.
pub fn run(stand: &Stand) -> Outcome {
    let base = Setup::periodic(CELLS, (1.0 / 1.9 - 0.5) / 3.0);
    let changed = |change: &dyn Fn(&mut Setup)| {
        let mut setup = base.clone();
        change(&mut setup);
        setup
    };
    let bgk = changed(&|s| s.collision = Collision::Bgk);
    let equal = |collision| {
        let mut setup = base.clone();
        setup.collision = collision;
        setup.rates = Rates::equal(1.0 / setup.tau());
        setup
    };
    let mut suga_second = equal(Collision::Suga);
    suga_second.equilibrium = Equilibrium::SecondOrder;
    let mut bgk_second = bgk.clone();
    bgk_second.equilibrium = Equilibrium::SecondOrder;
    let no_force = Force::Constant([0.0; 3]);
    let mut suga_wale = suga(CELLS);
    suga_wale.wale = Some(0.0);
    let pairs = [
        (
            "WALE with C_w = 0 - laminar",
            changed(&|s| s.wale = Some(0.0)),
            base.clone(),
        ),
        ("WALE with C_w = 0 - laminar", suga_wale, suga(CELLS)),
        (
            "F = 0 - no force",
            changed(&|s| s.force = no_force.clone()),
            base.clone(),
        ),
        ("equal rates - BGK", equal(Collision::Hermite), bgk.clone()),
        ("equal rates - BGK", equal(Collision::Suga), bgk),
        ("equal rates - BGK", suga_second, bgk_second),
        (
            "listed bricks - all bricks",
            changed(&|s| s.solid = vec![false; 24 * 10 * 8]),
            base.clone(),
        ),
        (
            "four lanes - one lane",
            changed(&|s| s.lanes = 4),
            base.clone(),
        ),
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
    let mut setup = base.clone();
    setup.lanes = lanes;
    let mut with_cell = setup.clone();
    with_cell.solid = vec![false; 24 * 10 * 8];
    with_cell.solid[0] = true;
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
        .map(|(at, (a, b))| f64::from((a - b).abs()) / weight(at / n))
        .fold(0.0, f64::max)
}
