//! A periodic box of noise and shear after 50 steps, known in float64.

use super::{
    Outcome, Stand,
    fields::{hash32, weight},
};
use riprap::lattice::{C, Collision, Equilibrium, Force, Populations, Rates, Setup, Storage};
use std::f64::consts::TAU;

const CELLS: [u32; 3] = [12, 10, 8];
const STEPS: u64 = 50;
/// Σf, Σf² and f_1 at (3, 2, 1) in float64.
type Sums = [f64; 3];
const PLAIN: Sums = [960.092464484255, 119.97860279855975, 0.07707931536167875];
const FORCED: Sums = [960.092464484255, 119.93706318447632, 0.07853289024989864];
const WALE: Sums = [960.092464484255, 119.97977770593053, 0.07702011099166237];
const PRODUCT: Sums = [960.092464484255, 119.9786011214001, 0.07707880968927251];
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
            let w = weight(q);
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
    let changed = |change: &dyn Fn(&mut Setup)| {
        let mut setup = base.clone();
        change(&mut setup);
        setup
    };
    let force = Force::Constant([1e-4, -2e-4, 3e-4]);
    let variants = [
        ("plain", base.clone(), PLAIN, F32_LIMIT),
        ("plain", changed(&|s| s.lanes = 4), PLAIN, F32_LIMIT),
        (
            "body force",
            changed(&|s| s.force = force.clone()),
            FORCED,
            F32_LIMIT,
        ),
        ("WALE", changed(&|s| s.wale = Some(0.5)), WALE, F32_LIMIT),
        (
            "product equilibrium",
            changed(&|s| s.equilibrium = Equilibrium::Product),
            PRODUCT,
            F32_LIMIT,
        ),
        (
            "plain",
            changed(&|s| (s.storage, s.lanes) = (Storage::F16, 2)),
            PLAIN,
            F16_LIMIT,
        ),
        (
            "plain",
            changed(&|s| (s.storage, s.lanes) = (Storage::F16, 4)),
            PLAIN,
            F16_LIMIT,
        ),
    ];
    let mut records = Vec::new();
    for (name, setup, exact, limit) in variants {
        let start = with_own_velocity(noise_and_shear(CELLS));
        let mut flow = stand.resumed(setup, &start)?;
        flow.advance(STEPS)?;
        let end = flow.populations()?;
        let n = end.values.len() / 27;
        let full = |at: usize| f64::from(end.values[at]) + weight(at / n);
        let sum: f64 = (0..27 * n).map(full).sum();
        let squares: f64 = (0..27 * n).map(|at| full(at) * full(at)).sum();
        let single = full(n + 3 + 12 * (2 + 10));
        let error = (sum / exact[0] - 1.0)
            .abs()
            .max((squares / exact[1] - 1.0).abs())
            .max((single - exact[2]).abs() / weight(1));
        let quantity = format!("{name}: error of Σf, Σf², f₁/w₁");
        records.push(flow.trial().at_most(quantity, error, limit));
    }
    Ok(records)
}
