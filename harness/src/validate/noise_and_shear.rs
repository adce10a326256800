//! A periodic box of noise and shear: comparison with float64, models that must agree, and conservation.

use super::{CaseContext, Outcome, Record, Trial, fields::changed};
use kit::twin::{
    golden::{FORCE, FORCED, PLAIN, PRODUCT, WALE},
    lattice::W,
    noise::hash32,
};
use riprap::lattice::{C, Collision, Equilibrium, Force, Populations, Rates, Setup, Storage};
use std::f64::consts::TAU;

const GOLDEN_CELLS: [u32; 3] = [12, 10, 8];
const STEPS: u64 = 50;
/// Limits relative to the weights: five times the error of the populations in f32 and in 16-bit storage.
const F32_LIMIT: f64 = 1e-6;
const F16_LIMIT: f64 = 2e-3;

/// f_i(x) = 0.05 w_i (r − ½) + f_i^eq(1, u₀) of order 2, minus w_i; any number of cells.
fn noise_and_shear(cells: [u32; 3]) -> Populations {
    let [nx, ny, nz] = cells.map(|n| n as usize);
    let count = nx * ny * nz;
    let mut values: Vec<f32> = Vec::with_capacity(27 * count);
    for (q, c) in C.iter().enumerate() {
        for n in 0..count {
            let (x, y, z) = (n % nx, (n / nx) % ny, n / (nx * ny));
            let wave = |k: usize, n: usize| 0.02 * (TAU * k as f64 / n as f64).sin();
            let u = [wave(y, ny), wave(z, nz), wave(x, nx)];
            let r = f64::from(hash32((q + 27 * n) as u32)) / 4294967296.0;
            let cu: f64 = (0..3).map(|a| f64::from(c[a]) * u[a]).sum();
            let uu: f64 = u.iter().map(|u| u * u).sum();
            let w = W[q];
            let equilibrium = w * (3.0 * cu + 4.5 * cu * cu - 1.5 * uu);
            values.push((w * 0.05 * (r - 0.5) + equilibrium) as f32);
        }
    }
    // Velocity j/ρ for the eddy viscosity of the first step.
    let mut velocity = vec![0.0; 3 * count];
    for cell in 0..count {
        let f = |q: usize| f64::from(values[q * count + cell]);
        let rho = 1.0 + (0..27).map(f).sum::<f64>();
        for a in 0..3 {
            let j: f64 = (0..27).map(|q| f64::from(C[q][a]) * f(q)).sum();
            velocity[a * count + cell] = (j / rho) as f32;
        }
    }
    Populations {
        step: 0,
        cells,
        values,
        velocity,
        eddy_viscosity: Vec::new(),
        near_wall: Vec::new(),
        travelled: Vec::new(),
        outflow_state: Vec::new(),
    }
}

/// Suga's operator with s5 = 1.9 and the equilibrium of order 2.
fn suga(cells: [u32; 3]) -> Setup {
    let mut setup = Setup::periodic(cells, (1.0 / 1.9 - 0.5) / 3.0);
    setup.collision = Collision::Suga;
    setup.equilibrium = Equilibrium::SecondOrder;
    setup
}

/// A periodic box of noise and shear after 50 steps, against float64.
pub fn golden(context: &CaseContext) -> Outcome {
    let base = suga(GOLDEN_CELLS);
    let f16 = |lanes| changed(&base, |s| (s.storage, s.lanes) = (Storage::F16, lanes));
    let four = changed(&base, |s| s.lanes = 4);
    let forced = changed(&base, |s| s.force = Force::Constant(FORCE));
    let wale = changed(&base, |s| (s.wale, s.wale_interval) = (Some(0.5), 1));
    let product = changed(&base, |s| s.equilibrium = Equilibrium::Product);
    let variants = [
        ("plain", base.clone(), PLAIN, F32_LIMIT),
        ("plain", four, PLAIN, F32_LIMIT),
        ("body force", forced, FORCED, F32_LIMIT),
        ("WALE", wale, WALE, F32_LIMIT),
        ("product equilibrium", product, PRODUCT, F32_LIMIT),
        ("plain", f16(2), PLAIN, F16_LIMIT),
        ("plain", f16(4), PLAIN, F16_LIMIT),
    ];
    let mut records = Vec::new();
    for (name, setup, exact, limit) in variants {
        let start = noise_and_shear(GOLDEN_CELLS);
        let mut flow = context.resumed(setup, &start)?;
        flow.advance(STEPS)?;
        let end = flow.populations()?;
        let n = end.values.len() / 27;
        let full = |at: usize| f64::from(end.values[at]) + W[at / n];
        let sum: f64 = (0..27 * n).map(full).sum();
        let squares: f64 = (0..27 * n).map(|at| full(at) * full(at)).sum();
        let single = full(n + 3 + 12 * (2 + 10));
        let error = (sum / exact[0] - 1.0)
            .abs()
            .max((squares / exact[1] - 1.0).abs())
            .max((single - exact[2]).abs() / W[1]);
        let quantity = format!("{name}: error of Σf, Σf², f₁/w₁");
        records.push(flow.trial().at_most(quantity, error, limit));
    }
    Ok(records)
}

const NULL_CELLS: [u32; 3] = [24, 10, 8];
/// Sums taken in different orders differ by f32 round-off, some 1e-7 of the summands; the populations differ from their weights
/// by some 0.1.
const NULL_LIMIT: f64 = 1e-6;

/// A model with its constant at zero is the simpler model.
pub fn null_models(context: &CaseContext) -> Outcome {
    let base = Setup::periodic(NULL_CELLS, (1.0 / 1.9 - 0.5) / 3.0);
    let bgk = changed(&base, |s| s.collision = Collision::Bgk);
    let equal = |collision| {
        changed(&base, |s| {
            (s.collision, s.rates) = (collision, Some(Rates::equal(1.0 / s.tau())));
        })
    };
    let second = |setup: &Setup| changed(setup, |s| s.equilibrium = Equilibrium::SecondOrder);
    let null_wale = |setup: &Setup| changed(setup, |s| s.wale = Some(0.0));
    let null_force = changed(&base, |s| s.force = Force::Constant([0.0; 3]));
    let listed = changed(&base, |s| s.solid = vec![false; 24 * 10 * 8]);
    let four = changed(&base, |s| s.lanes = 4);
    let [hermite, suga_equal] = [Collision::Hermite, Collision::Suga].map(equal);
    let suga = suga(NULL_CELLS);
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
        let (trial, a) = end(context, setup, STEPS)?;
        let (_, b) = end(context, simpler, STEPS)?;
        let quantity = format!("{name}: largest Δf/w");
        records.push(trial.at_most(quantity, difference(&a, &b, |_| true), NULL_LIMIT));
    }
    for lanes in [1, 4] {
        records.push(flagged(context, &base, lanes)?);
    }
    Ok(records)
}

fn end(context: &CaseContext, setup: Setup, steps: u64) -> anyhow::Result<(Trial, Populations)> {
    let mut flow = context.resumed(setup, &noise_and_shear(NULL_CELLS))?;
    flow.advance(steps)?;
    Ok((flow.trial(), flow.populations()?))
}

/// One solid cell makes its bricks flagged ones. Its effect spreads by one cell per step; farther away the flagged kernel must
/// agree with the plain one.
fn flagged(context: &CaseContext, base: &Setup, lanes: u32) -> anyhow::Result<Record> {
    let steps = 3;
    let setup = changed(base, |s| s.lanes = lanes);
    let with_cell = changed(&setup, |s| {
        s.solid = (0..24 * 10 * 8).map(|n| n == 0).collect()
    });
    let (trial, a) = end(context, with_cell, steps)?;
    let (_, b) = end(context, setup, steps)?;
    let reached = |x: usize| x.min(24 - x) as u64 <= steps + 1;
    let error = difference(&a, &b, |cell| !reached(cell % 24));
    Ok(trial.at_most(
        "flagged cells - plain cells: largest Δf/w",
        error,
        NULL_LIMIT,
    ))
}

/// Largest difference of a population over its weight, in the cells selected by `counts`.
fn difference(a: &Populations, b: &Populations, counts: impl Fn(usize) -> bool) -> f64 {
    let n = a.values.len() / 27;
    let pairs = a.values.iter().zip(&b.values).enumerate();
    pairs
        .filter(|(at, _)| counts(at % n))
        .map(|(at, (a, b))| f64::from((a - b).abs()) / W[at / n])
        .fold(0.0, f64::max)
}

const BOX: [u32; 3] = [16, 16, 16];
const LONG_STEPS: u64 = 10_000;
/// Limit on the drift over Σf and over Σ|c f̃|: round-off of f32 in random directions.
const DRIFT_LIMIT: f64 = 1e-6;

/// Mass and momentum of a periodic box over 10⁴ steps.
pub fn conservation(context: &CaseContext) -> Outcome {
    let hermite = context.setup(BOX, 0.05 / 3.0);
    let setups = [
        hermite.clone(),
        changed(&suga(BOX), |s| s.lanes = hermite.lanes),
        changed(&hermite, |s| s.collision = Collision::Bgk),
        changed(&hermite, |s| s.wale = Some(0.5)),
        changed(&hermite, |s| (s.storage, s.lanes) = (Storage::F16, 4)),
    ];
    let mut records = Vec::new();
    for setup in setups {
        let limit = (setup.storage == Storage::F32).then_some(DRIFT_LIMIT);
        let start = noise_and_shear(BOX);
        let before = Totals::of(&start);
        let mut flow = context.resumed(setup, &start)?;
        flow.advance(LONG_STEPS)?;
        let after = Totals::of(&flow.populations()?);
        let mass = (after.mass - before.mass).abs() / before.mass;
        let momentum = (0..3)
            .map(|a| (after.momentum[a] - before.momentum[a]).abs() / before.scale[a])
            .fold(0.0, f64::max);
        let trial = flow.trial();
        for (quantity, drift) in [("drift of Σf", mass), ("drift of Σ c f̃ / Σ|c f̃|", momentum)]
        {
            records.push(trial.at_most(quantity, drift, limit));
        }
    }
    Ok(records)
}

struct Totals {
    mass: f64,
    momentum: [f64; 3],
    /// Σ |c f̃| along each axis.
    scale: [f64; 3],
}

impl Totals {
    fn of(populations: &Populations) -> Self {
        let n = populations.values.len() / 27;
        let mut totals = Self {
            mass: n as f64,
            momentum: [0.0; 3],
            scale: [0.0; 3],
        };
        for (at, &f) in populations.values.iter().enumerate() {
            let f = f64::from(f);
            totals.mass += f;
            for a in 0..3 {
                let c = f64::from(C[at / n][a]);
                totals.momentum[a] += c * f;
                totals.scale[a] += (c * f).abs();
            }
        }
        totals
    }
}
