//! Vortices and shear waves that keep their shape as they decay: order of convergence and viscosity.

use super::{CaseContext, Method, Outcome, Trial, fields};
use riprap::lattice::Equilibrium;
use std::f64::consts::{LN_2, TAU};

/// Viscosity on every grid: in diffusive scaling the time step is proportional to the square of the cell size.
const NU: f64 = 0.05;
/// Relaxation time for that viscosity.
pub const TAU_OF_VORTICES: f64 = 0.5 + 3.0 * NU;
/// Velocity on the coarsest grid, 16 cells; it is proportional to the cell size, so that compressibility errors fall with the
/// square.
const COARSE_SPEED: f64 = 0.04;
const SIZES: [u32; 3] = [16, 32, 64];
/// Least order that a second-order scheme shows on these grids.
const LEAST_ORDER: f64 = 1.95;
/// Limit on the relative error of the viscosity on 64 cells: (2π/64)² = 0.01 times the leading coefficient of the error, 0.1.
const VISCOSITY_LIMIT: f64 = 1e-3;

/// A decaying flow in units of its speed, on a periodic box of edge 2π.
struct Vortices {
    /// Whether the flow is the same at every z.
    flat: bool,
    /// The amplitude falls as exp(−rate ν k² t).
    rate: f64,
    /// The amplitude falls to exp(−loss) during the run: long enough for the initial sound to decay, which arises because the
    /// start has no divergence while the pressure decays.
    loss: f64,
    velocity: fn([f64; 3]) -> [f64; 3],
    pressure: fn([f64; 3]) -> f64,
}

/// Taylor & Green 1937, two-dimensional.
const TAYLOR_GREEN: Vortices = Vortices {
    flat: true,
    rate: 2.0,
    loss: 3.0 * LN_2,
    velocity: |[x, y, _]| [x.sin() * y.cos(), -x.cos() * y.sin(), 0.0],
    pressure: |[x, y, _]| 0.25 * ((2.0 * x).cos() + (2.0 * y).cos()),
};

/// Order of convergence and viscosity of the vortices of Taylor & Green.
pub fn taylor_green(context: &CaseContext) -> Outcome {
    convergence(context, &TAYLOR_GREEN)
}

/// The vortices of Taylor & Green on `n` cells along each edge.
pub fn taylor_green_on(context: &CaseContext, n: u32, method: Method) -> anyhow::Result<Decay> {
    TAYLOR_GREEN.decay(context, n, method)
}

/// Arnold, Beltrami & Childress (Dombre et al. 1986), A = B = C: curl u = u, so that p + u²/2 is
/// the same everywhere.
pub fn abc_flow(context: &CaseContext) -> Outcome {
    fn velocity([x, y, z]: [f64; 3]) -> [f64; 3] {
        // The largest speed of the sum is about 2.
        [
            0.5 * (z.sin() + y.cos()),
            0.5 * (x.sin() + z.cos()),
            0.5 * (y.sin() + x.cos()),
        ]
    }
    convergence(
        context,
        &Vortices {
            flat: false,
            rate: 1.0,
            loss: LN_2,
            velocity,
            // The mean of u² is 3/4: the mean density stays 1.
            pressure: |at| 0.375 - 0.5 * velocity(at).iter().map(|u| u * u).sum::<f64>(),
        },
    )
}

/// Results on one grid.
pub struct Decay {
    /// Setup and cost of the run.
    pub trial: Trial,
    /// L2 error of the velocity at the end.
    pub error: f64,
    /// Viscosity over the nominal one.
    pub viscosity: f64,
}

impl Vortices {
    fn decay(&self, context: &CaseContext, n: u32, method: Method) -> anyhow::Result<Decay> {
        let cells = [n, n, if self.flat { 4 } else { n }];
        let k = TAU / f64::from(n);
        let speed = COARSE_SPEED * f64::from(SIZES[0]) / f64::from(n);
        let scaled = |at: [f64; 3]| at.map(|x| k * x);
        let decay = |steps: f64| (-self.rate * NU * k * k * steps).exp();
        let start = fields::state(cells, |at| {
            let at = scaled(at);
            let excess = 3.0 * speed * speed * (self.pressure)(at);
            (excess, (self.velocity)(at).map(|u| speed * u))
        });
        let half = (0.5 * self.loss / (self.rate * NU * k * k)).round();
        let mut setup = context.setup(cells, NU);
        method.arrange(&mut setup);
        let mut run = context.flow(setup, &start, true)?;
        let mode = |at| (self.velocity)(scaled(at)).map(|u| speed * u);
        run.advance(half as u64)?;
        let middle = fields::amplitude(cells, &run.state()?, mode);
        run.advance(half as u64)?;
        let state = run.state()?;
        let end = fields::amplitude(cells, &state, mode);
        Ok(Decay {
            trial: run.trial(),
            error: fields::l2_error(cells, &state, |at| mode(at).map(|u| decay(2.0 * half) * u)),
            viscosity: (middle / end).ln() / (self.rate * k * k * half) / NU,
        })
    }
}

fn convergence(context: &CaseContext, flow: &Vortices) -> Outcome {
    let mut records = Vec::new();
    let mut errors = Vec::new();
    for n in SIZES {
        let found = flow.decay(context, n, Method::DEFAULT)?;
        let trial = found.trial;
        records.push(trial.report(format!("L2 error of u, {n} cells"), found.error));
        let quantity = format!("viscosity / nominal, {n} cells");
        let limit = (n == SIZES[2]).then_some(VISCOSITY_LIMIT);
        records.push(trial.relative(quantity, found.viscosity, 1.0, limit));
        errors.push(found.error);
        if n == SIZES[2] {
            let coarse = (errors[0] / errors[1]).log2();
            let fine = (errors[1] / errors[2]).log2();
            records.push(trial.relative("order, 16 to 32 cells", coarse, 2.0, None));
            records.push(trial.at_least("order, 32 to 64 cells", fine, LEAST_ORDER));
        }
    }
    Ok(records)
}

const WAVE_CELLS: u32 = 64;
const WAVE_NU: f64 = 0.01;
/// Amplitude of the wave: far above f32 round-off, far below the speed that carries it.
const WAVE_SPEED: f64 = 0.005;
/// Times that the wave crosses the box.
const CROSSINGS: f64 = 8.0;
/// Limit on the relative error of the viscosity.
const LIMIT: f64 = 1e-3;

/// Galilean invariance: a shear wave carried along an axis decays like one at rest.
pub fn shear_wave(context: &CaseContext) -> Outcome {
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
        let cells = [WAVE_CELLS, 4, 4];
        let mut setup = context.setup(cells, WAVE_NU);
        setup.equilibrium = equilibrium;
        let k = TAU / f64::from(WAVE_CELLS);
        let start = fields::state(cells, |[x, _, _]| {
            (0.0, [speed, WAVE_SPEED * (k * x).sin(), 0.0])
        });
        let mut flow = context.flow(setup, &start, true)?;
        // Whole crossings at both speeds, so that a wave that is not quite a sine is weighted equally both times.
        let steps = CROSSINGS / 2.0 * f64::from(WAVE_CELLS) / 0.1;
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
        records.push(trial.relative(quantity, nu / WAVE_NU, expected, limit));
    }
    Ok(records)
}
