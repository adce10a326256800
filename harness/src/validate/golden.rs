//! A periodic box of noise and shear after 50 steps, known in float64.

use super::{Outcome, Stand, fields::changed};
use kit::twin::{
    golden::{FORCE, FORCED, PLAIN, PRODUCT, WALE},
    lattice::W,
    noise::hash32,
};
use riprap::lattice::{C, Collision, Equilibrium, Force, Populations, Rates, Setup, Storage};
use std::f64::consts::TAU;

const CELLS: [u32; 3] = [12, 10, 8];
const STEPS: u64 = 50;
/// Relative to the weights: five times what f32 and 16-bit storage do to the populations.
const F32_LIMIT: f64 = 1e-6;
const F16_LIMIT: f64 = 2e-3;

/// f_i(x) = 0.05 w_i (r − ½) + f_i^eq(1, u₀) of order 2, minus w_i; any number of cells.
pub fn noise_and_shear(cells: [u32; 3]) -> Populations {
    let [nx, ny, nz] = cells.map(|n| n as usize);
    let count = nx * ny * nz;
    let mut values = Vec::with_capacity(27 * count);
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
    Populations {
        step: 0,
        cells,
        values,
        velocity: Vec::new(),
        carried: Vec::new(),
    }
}

/// Gives the populations the velocity j/ρ that the eddy viscosity of the first step looks at.
pub fn with_own_velocity(mut populations: Populations) -> Populations {
    let n = populations.values.len() / 27;
    populations.velocity = vec![0.0; 3 * n];
    for cell in 0..n {
        let f = |q: usize| f64::from(populations.values[q * n + cell]);
        let rho = 1.0 + (0..27).map(f).sum::<f64>();
        for a in 0..3 {
            let j: f64 = (0..27).map(|q| f64::from(C[q][a]) * f(q)).sum();
            populations.velocity[a * n + cell] = (j / rho) as f32;
        }
    }
    populations
}

/// Suga's operator with s5 = 1.9 and the equilibrium of order 2.
pub fn suga(cells: [u32; 3]) -> Setup {
    let mut setup = Setup::periodic(cells, (1.0 / 1.9 - 0.5) / 3.0);
    setup.collision = Collision::Suga;
    setup.rates = Rates::SUGA;
    setup.equilibrium = Equilibrium::SecondOrder;
    setup
}

/// Runs the case.
pub fn run(stand: &Stand) -> Outcome {
    let base = suga(CELLS);
    let f16 = |lanes| changed(&base, |s| (s.storage, s.lanes) = (Storage::F16, lanes));
    let four = changed(&base, |s| s.lanes = 4);
    let forced = changed(&base, |s| s.force = Force::Constant(FORCE));
    let wale = changed(&base, |s| s.wale = Some(0.5));
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
        let start = with_own_velocity(noise_and_shear(CELLS));
        let mut flow = stand.resumed(setup, &start)?;
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
