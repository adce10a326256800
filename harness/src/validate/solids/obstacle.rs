//! Drag of a sphere and of a cube in a stream.
//!
//! A quarter of each body is computed, between planes of symmetry; the other sides slip. They are ten sizes apart if the
//! reference is an unbounded stream, so that the body takes up less than 1 % of the section.

use crate::validate::{
    CaseContext, Method, Outcome, Trial,
    tank::{self, Tank, block, numbers},
};
use riprap::scene::{BlockShape, Boundary, Motion};
use std::f64::consts::PI;

const SPEED: f64 = 0.05;
/// Time over which the drag is averaged, in body sizes over speed.
const MEAN: f64 = 4.0;

/// Sphere, against body-fitted computations in an unbounded stream.
pub fn sphere(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    for (size, limit) in grids(context) {
        for (reynolds, published) in [(20.0, 2.71), (100.0, 1.087)] {
            let edge = f64::from(size);
            let shape = BlockShape::Sphere { radius: 0.5 * edge };
            let drag = WIDE.drag(context, shape, (size, edge / reynolds), Method::DEFAULT)?;
            let coefficient = drag.coefficient / (0.25 * PI * edge * edge);
            let quantity = format!("C_d / published, sphere, Re {reynolds}, D = {size}");
            let ratio = coefficient / published;
            records.push(drag.trial.relative(quantity, ratio, 1.0, limit));
        }
    }
    Ok(records)
}

/// Cube with a face across the stream, against the correlation of Hölzer & Sommerfeld (2008), eq. 9.
pub fn cube(context: &CaseContext) -> Outcome {
    // Diameter, section and surface of the sphere of the same volume, over those of the cube.
    let diameter = (6.0 / PI).cbrt();
    let across = 0.25 * PI * diameter * diameter;
    let sphericity: f64 = PI * diameter * diameter / 6.0;
    // Section over half the surface less the mean section along the stream.
    let lengthwise = across / (3.0 - 1.0);
    let mut records = Vec::new();
    for (size, limit) in grids(context) {
        for reynolds in [20.0f64, 100.0] {
            let published = 8.0 / (reynolds * lengthwise.sqrt())
                + 16.0 / (reynolds * sphericity.sqrt())
                + 3.0 / (reynolds.sqrt() * sphericity.powf(0.75))
                + 0.42 * 10f64.powf(0.4 * (-sphericity.log10()).powf(0.2)) / across;
            let edge = f64::from(size);
            let shape = BlockShape::Box { size: [edge; 3] };
            let scale = diameter * edge / reynolds;
            let drag = WIDE.drag(context, shape, (size, scale), Method::DEFAULT)?;
            let coefficient = drag.coefficient / (across * edge * edge);
            let quantity = format!("C_d / correlation, cube, Re {reynolds}, L = {size}");
            let ratio = coefficient / published;
            records.push(drag.trial.relative(quantity, ratio, 1.0, limit));
        }
    }
    Ok(records)
}

/// Cells across the body, and the limit on the error of the drag. The finer grid takes half an hour per stream on two cores.
fn grids(context: &CaseContext) -> Vec<(u32, f64)> {
    match context.software && !context.full {
        true => vec![(12, 0.12)],
        false => vec![(12, 0.12), (24, 0.05)],
    }
}

/// Domain around a body, in body sizes, and times, in body sizes over speed.
#[derive(Clone, Copy)]
struct Stream {
    /// Length before its middle.
    before: u32,
    /// Length behind its middle.
    behind: u32,
    /// Half the width.
    half_width: u32,
    /// Time until the drag is steady.
    settle: f64,
}

/// Wide enough for the values of an unbounded stream.
const WIDE: Stream = Stream {
    before: 4,
    behind: 8,
    half_width: 5,
    settle: 20.0,
};
/// The same flow on every grid, to compare grids with each other: small, so that fine ones are affordable.
const NARROW: Stream = Stream {
    before: 3,
    behind: 5,
    half_width: 3,
    settle: 12.0,
};

/// Drag on a body in a stream.
pub struct Drag {
    /// Drag coefficient with ρU²/2 and the section.
    pub coefficient: f64,
    /// Relaxation time.
    pub tau: f64,
    /// Largest y⁺ half a cell from the body.
    pub y_plus: Option<f64>,
    /// Setup and cost of the run.
    pub trial: Trial,
}

/// Drag on a cube of `size` cells, face on, in the narrow stream; the Reynolds number is that of its edge.
pub fn cube_on(
    context: &CaseContext,
    size: u32,
    reynolds: f64,
    method: Method,
) -> anyhow::Result<Drag> {
    let edge = f64::from(size);
    let shape = BlockShape::Box { size: [edge; 3] };
    let mut drag = NARROW.drag(context, shape, (size, edge / reynolds), method)?;
    drag.coefficient /= edge * edge;
    Ok(drag)
}

impl Stream {
    /// Drag on the whole body with the viscosity `SPEED` × `scale`; the coefficient is for a section of one cell.
    fn drag(
        &self,
        context: &CaseContext,
        shape: BlockShape,
        (size, scale): (u32, f64),
        method: Method,
    ) -> anyhow::Result<Drag> {
        let tau = 0.5 + 3.0 * SPEED * scale;
        let side = self.half_width * size;
        let mut scene = tank::scene([(self.before + self.behind) * size, side, side], tau)?;
        let stream = [SPEED, 0.0, 0.0];
        scene.initial.velocity = numbers(stream);
        let faces = &mut scene.boundaries;
        faces.x_min = Boundary::Velocity {
            velocity: numbers(stream),
            turbulence: None,
        };
        faces.x_max = Boundary::Pressure {
            pressure: 0.0.into(),
            reflecting: false,
        };
        (faces.y_min, faces.y_max) = (Boundary::FreeSlip, Boundary::FreeSlip);
        (faces.z_min, faces.z_max) = (Boundary::FreeSlip, Boundary::FreeSlip);
        let at = [f64::from(self.before * size), 0.0, 0.0];
        scene.blocks.push(block(shape, at, Motion::Driven));
        let steps = |times: f64| (times * f64::from(size) / SPEED) as u64;
        const READINGS: u64 = 40;
        let every = steps(MEAN) / READINGS;
        scene.coupling.interval = every as u32;
        method.choose(&mut scene);
        let mut tank = Tank::fill(context, &scene)?;
        tank.advance(steps(self.settle) / every * every)?;
        let mut sum = 0.0;
        for _ in 0..READINGS {
            tank.advance(every)?;
            sum += tank.load(0).flow.force.x;
        }
        // Four quarters, and ρ = 1.
        let force = 4.0 * sum / READINGS as f64;
        Ok(Drag {
            coefficient: force / (0.5 * SPEED * SPEED),
            tau,
            y_plus: tank.y_plus()?,
            trial: tank.trial("a quarter between planes of symmetry"),
        })
    }
}
