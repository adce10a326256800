//! Drag of a sphere and of a cube in a stream.
//!
//! A quarter of each is computed, between planes of symmetry; the other sides slip, ten sizes apart, so that the body
//! takes up less than 1 % of the section.

use super::{
    super::{Outcome, Stand, Trial},
    tank::{self, Tank, block, numbers},
};
use riprap::scene::{BlockShape, Boundary, Motion};
use std::f64::consts::PI;

const SPEED: f64 = 0.05;
/// Length before and behind the body, and half the width, in sizes of the body.
const BEFORE: u32 = 4;
const BEHIND: u32 = 8;
const HALF_WIDTH: u32 = 5;
/// Time until the drag is steady, and over which it is averaged, in sizes over speed.
const SETTLE: f64 = 20.0;
const MEAN: f64 = 4.0;

/// Against body-fitted computations of a sphere in an unbounded stream.
pub fn sphere(stand: &Stand) -> Outcome {
    let mut records = Vec::new();
    for (size, limit) in grids(stand) {
        for (reynolds, published) in [(20.0, 2.71), (100.0, 1.087)] {
            let edge = f64::from(size);
            let shape = BlockShape::Sphere { radius: 0.5 * edge };
            let (force, trial) = drag(stand, shape, size, edge / reynolds)?;
            let coefficient = force / (0.5 * SPEED * SPEED * 0.25 * PI * edge * edge);
            let quantity = format!("C_d / published, sphere, Re {reynolds}, D = {size}");
            records.push(trial.relative(quantity, coefficient / published, 1.0, limit));
        }
    }
    Ok(records)
}

/// Against the correlation of Hölzer & Sommerfeld (2008), eq. 9, for a face across the stream.
pub fn cube(stand: &Stand) -> Outcome {
    // Of the sphere of the same volume: its diameter, its section and its surface over those of the cube.
    let diameter = (6.0 / PI).cbrt();
    let across = 0.25 * PI * diameter * diameter;
    let sphericity: f64 = PI * diameter * diameter / 6.0;
    // Section over half the surface less the mean section along the stream.
    let lengthwise = across / (3.0 - 1.0);
    let mut records = Vec::new();
    for (size, limit) in grids(stand) {
        for reynolds in [20.0f64, 100.0] {
            let published = 8.0 / (reynolds * lengthwise.sqrt())
                + 16.0 / (reynolds * sphericity.sqrt())
                + 3.0 / (reynolds.sqrt() * sphericity.powf(0.75))
                + 0.42 * 10f64.powf(0.4 * (-sphericity.log10()).powf(0.2)) / across;
            let edge = f64::from(size);
            let shape = BlockShape::Box { size: [edge; 3] };
            let (force, trial) = drag(stand, shape, size, diameter * edge / reynolds)?;
            let coefficient = force / (0.5 * SPEED * SPEED * across * edge * edge);
            let quantity = format!("C_d / correlation, cube, Re {reynolds}, L = {size}");
            records.push(trial.relative(quantity, coefficient / published, 1.0, limit));
        }
    }
    Ok(records)
}

/// Cells across the body, and how far off the drag may be. The finer one is for GPUs.
fn grids(stand: &Stand) -> Vec<(u32, f64)> {
    match stand.software {
        true => vec![(12, 0.12)],
        false => vec![(12, 0.12), (24, 0.05)],
    }
}

/// Drag of the whole body with the viscosity `SPEED` × `scale`.
fn drag(stand: &Stand, shape: BlockShape, size: u32, scale: f64) -> anyhow::Result<(f64, Trial)> {
    let tau = 0.5 + 3.0 * SPEED * scale;
    let side = HALF_WIDTH * size;
    let mut scene = tank::scene([(BEFORE + BEHIND) * size, side, side], tau)?;
    let stream = [SPEED, 0.0, 0.0];
    scene.initial.velocity = numbers(stream);
    let faces = &mut scene.boundaries;
    faces.x_min = Boundary::Velocity {
        velocity: numbers(stream),
    };
    faces.x_max = Boundary::Pressure {
        pressure: 0.0,
        reflecting: false,
    };
    (faces.y_min, faces.y_max) = (Boundary::FreeSlip, Boundary::FreeSlip);
    (faces.z_min, faces.z_max) = (Boundary::FreeSlip, Boundary::FreeSlip);
    let at = [f64::from(BEFORE * size), 0.0, 0.0];
    scene.blocks.push(block(shape, at, Motion::Driven));
    let steps = |times: f64| (times * f64::from(size) / SPEED) as u64;
    const READINGS: u64 = 40;
    let every = steps(MEAN) / READINGS;
    scene.coupling.interval = every as u32;
    let mut tank = Tank::fill(stand, &scene)?;
    tank.advance(steps(SETTLE) / every * every)?;
    let mut sum = 0.0;
    for _ in 0..READINGS {
        tank.advance(every)?;
        sum += tank.felt(0).flow.force.x;
    }
    let what = "a quarter between planes of symmetry";
    Ok((4.0 * sum / READINGS as f64, tank.trial(what)))
}
