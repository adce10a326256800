//! Drag of a simple cubic array of spheres (Zick & Homsy 1982): F = 6πμaKU, where F is the total force on a sphere and U the mean
//! velocity over fluid and spheres.

use super::periodic_flow::{Body, Drag, PeriodicFlow, static_solids};
use crate::validate::{CaseContext, Method, Outcome, Record};
use riprap::scene::{BlockShape, Rotation, Solid, SolidSurface};
use std::f64::consts::PI;

/// Concentrations and K from their table 2.
const K: [(f64, f64); 4] = [
    (0.027, 2.008),
    (0.125, 4.292),
    (0.216, 7.442),
    (0.343, 15.4),
];
/// The concentration with limits.
pub const USUAL: f64 = 0.125;
/// Offsets of the spheres from the corner of a cell, in cells.
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
    /// Surface of spheres that are static solids; `None` for blocks.
    surface: Option<SolidSurface>,
}

impl Array {
    /// An array computed by the default method, each sphere in the middle of its cube.
    pub fn new(concentration: f64, edge: u32, tau: f64) -> Self {
        Self {
            concentration,
            edge,
            tau,
            method: Method::DEFAULT,
            offset: [0.0; 3],
            surface: None,
        }
    }

    /// The same array by another method.
    pub fn by(self, method: Method) -> Self {
        Self { method, ..self }
    }

    /// Cells across a sphere.
    pub fn diameter(&self) -> f64 {
        f64::from(self.edge) * (6.0 * self.concentration / PI).cbrt()
    }

    /// K from the table.
    fn published(&self) -> f64 {
        let found = K.iter().find(|(c, _)| *c == self.concentration);
        found.map_or(f64::NAN, |(_, k)| *k)
    }

    /// [`Drag::resistance`] from the table.
    pub fn resistance(&self) -> f64 {
        3.0 * PI * self.diameter() * self.published()
    }

    /// Computes the flow through the array.
    pub fn measure(&self, context: &CaseContext) -> anyhow::Result<Measured> {
        let radius = 0.5 * self.diameter();
        let body = match self.surface {
            Some(surface) => Body::Cells(static_sphere(self.edge, radius, surface)?),
            None => Body::Block(
                BlockShape::Sphere { radius },
                self.offset,
                Rotation::default(),
            ),
        };
        let expected = self.resistance();
        let flow = PeriodicFlow {
            body,
            size: self.diameter(),
            edge: self.edge,
            tau: self.tau,
            method: self.method,
            expected,
        };
        let drag = flow.measure(context, &format!("spheres c {}", self.concentration))?;
        Ok(Measured {
            ratio: drag.resistance / expected,
            drag,
        })
    }
}

/// Result for an array.
pub struct Measured {
    /// K over that from the table.
    pub ratio: f64,
    /// The flow and its cost.
    pub drag: Drag,
}

impl Measured {
    fn record(&self, array: &Array, limit: Option<f64>) -> Record {
        let (diameter, tau, method) = (array.diameter(), array.tau, array.method.name);
        let quantity = format!("K / K(Z&H), D = {diameter:.1}, τ = {tau}, {method}");
        self.drag.trial.relative(quantity, self.ratio, 1.0, limit)
    }
}

/// Spheres of 5 and 10 cells; with `--full` finer ones and other concentrations.
pub fn drag(context: &CaseContext) -> Outcome {
    // Concentration, edge of the cube, limit. For the usual concentration, 8, 16, 24 and 32 cells give D = 5.0, 9.9, 14.9 and
    // 19.9; for the others D = 9.3 and 11.9.
    let mut arrays = vec![(USUAL, 8, 3e-2), (USUAL, 16, 1e-2)];
    if context.full {
        arrays.extend([(USUAL, 24, 1e-2), (USUAL, 32, 1e-2)]);
        arrays.extend([(0.027, 25, 1e-2), (0.216, 16, 1e-2)]);
    }
    let each = |(concentration, edge, limit)| {
        let array = move |tau| (Array::new(concentration, edge, tau), tau, limit);
        [0.52, 0.6, 1.0, 1.5].map(array)
    };
    let mut records = Vec::new();
    for (array, tau, limit) in arrays.into_iter().flat_map(each) {
        if context.software && array.edge > 16 && tau < QUICK {
            continue;
        }
        let found = array.measure(context)?;
        records.push(found.record(&array, Some(limit)));
        let quantity = "force on the sphere / push on the fluid − 1";
        let balance = found.drag.balance.abs();
        records.push(found.drag.trial.at_most(quantity, balance, 1e-3));
    }
    Ok(records)
}

/// A static solid in the middle of a cube.
fn static_sphere(edge: u32, radius: f64, surface: SolidSurface) -> anyhow::Result<Vec<Solid>> {
    let middle = 0.5 * f64::from(edge);
    let kind = match surface {
        SolidSurface::Exact => "exact",
        SolidSurface::Staircase => "staircase",
    };
    static_solids(
        edge,
        &format!(
            "kind = \"sphere\"\ncenter = [{middle}, {middle}, {middle}]\nradius = {radius}\nsurface = \"{kind}\""
        ),
    )
}

/// Spheres of 10 cells as static solids: exact surfaces, judged like blocks, and staircases.
pub fn at_rest(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    for tau in [0.6, 1.0, 1.5] {
        for (surface, name, limit) in [
            (SolidSurface::Exact, "exact", Some(1e-2)),
            (SolidSurface::Staircase, "staircase", None),
        ] {
            let array = Array {
                surface: Some(surface),
                ..Array::new(USUAL, 16, tau)
            };
            let found = array.measure(context)?;
            let diameter = array.diameter();
            let quantity = format!("{name}: K / K(Z&H), D = {diameter:.1}, τ = {tau}");
            let trial = &found.drag.trial;
            records.push(trial.relative(quantity, found.ratio, 1.0, limit));
        }
    }
    Ok(records)
}

/// The position of the centre of a sphere within its cell must not matter.
pub fn offset(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    for tau in [0.6, 1.0] {
        let straight = Array::new(USUAL, 16, tau);
        let expected = straight.measure(context)?.ratio;
        for offset in OFFSETS {
            let found = Array { offset, ..straight }.measure(context)?;
            let quantity = format!("K off by {offset:?} / K, τ = {tau}");
            let ratio = found.ratio / expected;
            records.push(found.drag.trial.relative(quantity, ratio, 1.0, 3e-3));
        }
    }
    Ok(records)
}

/// Other concentrations and the other operators, for which there are no limits.
pub fn comparison(context: &CaseContext) -> Outcome {
    let mut arrays = vec![Array::new(0.027, 16, 1.0), Array::new(0.343, 12, 1.0)];
    let operators = [
        Method::NOBLE,
        Method::SUPERPOSITION,
        Method::STANDARD_WEIGHT,
    ];
    arrays.extend(operators.map(|operator| Array::new(USUAL, 16, 1.0).by(operator)));
    if context.full {
        for tau in [0.6, 1.0] {
            arrays.extend([Array::new(0.027, 28, tau), Array::new(0.343, 12, tau)]);
            arrays.push(Array::new(0.343, 24, tau));
        }
        arrays.extend(operators.map(|operator| Array::new(USUAL, 16, 0.6).by(operator)));
    }
    let mut records = Vec::new();
    for array in arrays {
        records.push(array.measure(context)?.record(&array, None));
    }
    Ok(records)
}

/// Relaxation time from which large spheres run in reasonable time: the flow is steady after some 330/ν steps at D = 20, and
/// 1300/ν at D = 40.
const QUICK: f64 = 0.8;

/// The error over resolution and relaxation time.
pub fn map(context: &CaseContext) -> Outcome {
    // D = 5, 9.9, 19.9, 39.7, and the smallest relaxation time for each.
    let slow = if context.software { QUICK } else { 0.0 };
    let grids: &[(u32, f64)] = match context.full {
        true => &[(8, 0.0), (16, 0.0), (32, 0.0), (64, slow)],
        false => &[(8, 0.0), (16, 0.0), (32, QUICK)],
    };
    let mut records = Vec::new();
    for &(edge, least) in grids {
        for tau in [0.55, 0.6, 0.8, 1.0, 1.5] {
            if tau >= least {
                let array = Array::new(USUAL, edge, tau);
                records.push(array.measure(context)?.record(&array, None));
            }
        }
    }
    Ok(records)
}
