//! Drag of a simple cubic array of spheres (Zick & Homsy 1982): F = 6πμaKU, F the whole force on a sphere and U
//! the mean velocity over fluid and spheres.

use crate::picture::{Chart, Curve, Mark, Measure};
use crate::validate::{
    Method, Outcome, Record, Stand, Trial,
    tank::{self, Tank, block, numbers},
};
use riprap::scene::{BlockShape, Motion};
use std::f64::consts::{PI, TAU};

/// Concentrations and K of their table 2.
const K: [(f64, f64); 3] = [(0.027, 2.008), (0.125, 4.292), (0.343, 15.4)];
/// The concentration for which there are limits.
pub const USUAL: f64 = 0.125;
/// U D/ν: the drag of inertia grows with its square and is below 1e-4 of the whole.
const REYNOLDS: f64 = 0.05;
/// Part of a cell by which spheres are off its corner.
const OFFSETS: [[f64; 3]; 3] = [[0.25, 0.0, 0.0], [0.5, 0.5, 0.5], [0.3, 0.1, 0.7]];

/// An array to be computed.
#[derive(Clone, Copy)]
pub struct Array {
    concentration: f64,
    /// Edge of the periodic cube of one sphere, cells.
    edge: u32,
    tau: f64,
    method: Method,
    offset: [f64; 3],
}

impl Array {
    /// By the default method, each sphere in the middle of its cube.
    pub fn new(concentration: f64, edge: u32, tau: f64) -> Self {
        Self {
            concentration,
            edge,
            tau,
            method: Method::DEFAULT,
            offset: [0.0; 3],
        }
    }

    /// By another method.
    pub fn by(self, method: Method) -> Self {
        Self { method, ..self }
    }

    /// Cells across a sphere.
    pub fn diameter(&self) -> f64 {
        f64::from(self.edge) * (6.0 * self.concentration / PI).cbrt()
    }

    /// K of the table.
    fn published(&self) -> f64 {
        let found = K.iter().find(|(c, _)| *c == self.concentration);
        found.map_or(f64::NAN, |(_, k)| *k)
    }

    /// K as computed.
    ///
    /// # Errors
    /// If the flow does not become steady, or leaves the range of the method.
    pub fn measure(&self, stand: &Stand) -> anyhow::Result<Drag> {
        let nu = (self.tau - 0.5) / 3.0;
        let volume = f64::from(self.edge).powi(3);
        let stokes = 3.0 * PI * nu * self.diameter();
        let speed = REYNOLDS * nu / self.diameter();
        let push = stokes * self.published() * speed / volume;
        let mut scene = tank::scene([self.edge; 3], self.tau)?;
        scene.fluid.acceleration = numbers([push, 0.0, 0.0]);
        scene.initial.velocity = numbers([speed, 0.0, 0.0]);
        self.method.choose(&mut scene);
        let shape = BlockShape::Sphere {
            radius: 0.5 * self.diameter(),
        };
        let centre = self.offset.map(|part| 0.5 * f64::from(self.edge) + part);
        // Its loads are wanted, and it is at rest.
        scene.blocks.push(block(shape, centre, Motion::Driven));
        // A mean velocity that is off returns at the first rate, its profile at least at the second.
        let edge = f64::from(self.edge);
        let rates = [
            stokes * self.published() / volume,
            nu * (TAU / edge).powi(2),
        ];
        let time = (1.0 / rates[0].min(rates[1])).ceil();
        // The force is the mean over one such time.
        scene.coupling.interval = time as u32;
        let mut tank = Tank::fill(stand, &scene)?;
        let mut flux = f64::NAN;
        for times in 1.. {
            // What cells inside a sphere reflect swings with a period of two steps. Without the half force: in
            // partially saturated cells it is no part of the flux.
            tank.advance(time as u64 - 1)?;
            let before = tank.totals()?.momentum[0];
            tank.advance(1)?;
            let now = 0.5 * (before + tank.totals()?.momentum[0]) / volume - 0.5 * push;
            let change = (now - flux).abs();
            flux = now;
            if change <= STEADY * now.abs() {
                break;
            }
            anyhow::ensure!(
                times < MOST_TIMES,
                "the flow through the array is not steady after {} steps",
                tank.simulation.step()
            );
        }
        let force = tank.load(0).flow.force.x;
        Ok(Drag {
            ratio: force / (stokes * flux) / self.published(),
            balance: force / (push * volume) - 1.0,
            trial: tank.trial(&format!("spheres c {}", self.concentration)),
        })
    }
}

/// Change of the mean velocity, as a part of it, over the longer of its diffusive time (edge/2π)²/ν and the time in which
/// the drag stops it, below which the flow is steady: what is left then is of this size, a tenth of the limit on the
/// balance of forces.
const STEADY: f64 = 1e-4;
/// Such times after which a flow that is to become steady should be: 8 are usual.
const MOST_TIMES: u32 = 64;

/// What an array shows.
pub struct Drag {
    /// K over that of the table.
    pub ratio: f64,
    /// How far the force is from what pushes the fluid.
    balance: f64,
    /// What was run.
    pub trial: Trial,
}

impl Drag {
    fn record(&self, array: &Array, limit: Option<f64>) -> Record {
        let (diameter, tau, method) = (array.diameter(), array.tau, array.method.name);
        let quantity = format!("K / K(Z&H), D = {diameter:.1}, τ = {tau}, {method}");
        self.trial.relative(quantity, self.ratio, 1.0, limit)
    }
}

/// Spheres of 10 cells; with `--full` finer ones, a lower viscosity and other places in the grid.
pub fn drag(stand: &Stand) -> Outcome {
    // Edge of the cube, relaxation time, limit: 16, 24 and 32 cells give D = 9.9, 14.9 and 19.9.
    let mut runs = vec![(16, 0.6, 2.5e-2), (16, 1.0, 2.5e-2)];
    if stand.full {
        runs.extend([(16, 0.8, 2.5e-2), (16, 0.52, 5e-2)]);
        for edge in [24, 32] {
            runs.extend([(edge, 0.6, 2e-2), (edge, 1.0, 2e-2), (edge, 0.52, 4.5e-2)]);
        }
    }
    let mut records = Vec::new();
    for (edge, tau, limit) in runs {
        let array = Array::new(USUAL, edge, tau);
        let drag = array.measure(stand)?;
        records.push(drag.record(&array, Some(limit)));
        let quantity = "force on the sphere / push on the fluid − 1";
        records.push(drag.trial.at_most(quantity, drag.balance.abs(), 1e-3));
    }
    Ok(records)
}

/// Where the centre of a sphere is in its cell must not matter.
pub fn offset(stand: &Stand) -> Outcome {
    let mut records = Vec::new();
    for tau in [0.6, 1.0] {
        let straight = Array::new(USUAL, 16, tau);
        let expected = straight.measure(stand)?.ratio;
        for offset in OFFSETS {
            let drag = Array { offset, ..straight }.measure(stand)?;
            let quantity = format!("K off by {offset:?} / K, τ = {tau}");
            let ratio = drag.ratio / expected;
            records.push(drag.trial.relative(quantity, ratio, 1.0, 3e-3));
        }
    }
    Ok(records)
}

/// Other concentrations and the other operators, for which there are no limits.
pub fn comparison(stand: &Stand) -> Outcome {
    let mut arrays = vec![Array::new(0.027, 16, 1.0), Array::new(0.343, 12, 1.0)];
    let operators = [Method::NOBLE, Method::SUPERPOSITION];
    arrays.extend(operators.map(|operator| Array::new(USUAL, 16, 1.0).by(operator)));
    if stand.full {
        for tau in [0.6, 1.0] {
            arrays.extend([Array::new(0.027, 28, tau), Array::new(0.343, 12, tau)]);
            arrays.push(Array::new(0.343, 24, tau));
        }
        arrays.extend(operators.map(|operator| Array::new(USUAL, 16, 0.6).by(operator)));
    }
    let mut records = Vec::new();
    for array in arrays {
        records.push(array.measure(stand)?.record(&array, None));
    }
    Ok(records)
}

/// Relaxation time from which on large spheres do not take long: the flow is steady after some 330/ν steps at D = 20,
/// and 1300/ν at D = 40.
const QUICK: f64 = 0.8;

/// The error over resolution and relaxation time, as a table and a picture.
pub fn map(stand: &Stand) -> Outcome {
    // D = 5, 9.9, 19.9, 39.7, and the least relaxation time of each.
    let slow = if stand.software { QUICK } else { 0.0 };
    let grids: &[(u32, f64)] = match stand.full {
        true => &[(8, 0.0), (16, 0.0), (32, 0.0), (64, slow)],
        false => &[(8, 0.0), (16, 0.0), (32, QUICK)],
    };
    let (mut records, mut curves, mut table) = (Vec::new(), Vec::new(), Vec::new());
    for &(edge, least) in grids {
        let mut points = Vec::new();
        for tau in [0.55, 0.6, 0.8, 1.0, 1.5] {
            if tau < least {
                continue;
            }
            let array = Array::new(USUAL, edge, tau);
            let drag = array.measure(stand)?;
            records.push(drag.record(&array, None));
            let error = 100.0 * (drag.ratio - 1.0);
            points.push([tau, error]);
            let steps = drag.trial.steps as f64;
            table.push([array.diameter(), tau, error, steps, drag.trial.seconds]);
        }
        curves.push(Curve {
            name: format!("D = {:.1}", Array::new(USUAL, edge, 1.0).diameter()),
            points,
            mark: Mark::LinePoints,
        });
    }
    let chart = Chart::profile(
        "Error of the drag of a cubic array of spheres, c = 0.125",
        Measure::linear("relaxation time τ", ""),
        Measure::linear("K / K(Zick & Homsy) − 1", "%"),
        curves,
    );
    stand.draw("solids_array", &chart)?;
    let heads = ["diameter", "tau", "error_percent", "steps", "seconds"];
    stand.write_table("solids_array", heads, &table)?;
    Ok(records)
}
