//! A cylinder in a channel, Reynolds number 20: the steady plane flow 2D-1 of Schäfer & Turek (1996).

use crate::validate::{
    CaseContext, Outcome,
    tank::{self, Tank, block, numbers},
};
use riprap::{
    formula::Formula,
    scene::{BlockShape, Boundary, Motion},
};
use std::f64::consts::TAU;

/// Drag coefficient with the mean speed and the diameter: the bounds of the reference are 5.57 and 5.59.
const DRAG: f64 = 5.58;
/// Largest speed at the inlet; the mean is two thirds of it.
const SPEED: f64 = 0.06;
const REYNOLDS: f64 = 20.0;
/// Length of the channel, distance of the axis from inlet and lower wall, and distance of the walls, in diameters.
const LENGTH: f64 = 22.0;
const AXIS: f64 = 2.0;
const HEIGHT: f64 = 4.1;
/// Sides of the prism that represents the cylinder.
const SIDES: u32 = 96;
/// Layers of cells, along which nothing varies.
const LAYERS: u32 = 4;
/// Time until the drag is steady, in diameters over the mean speed.
const SETTLE: f64 = 16.0;

/// Drag on a grid of 10 cells per diameter, in the full form also of 20: the error falls to first order at best.
pub fn run(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    let grids: &[(u32, f64)] = match context.full {
        true => &[(10, 0.07), (20, 0.04)],
        false => &[(10, 0.07)],
    };
    for &(size, limit) in grids {
        let cells = f64::from(size);
        let mean = 2.0 / 3.0 * SPEED;
        let tau = 0.5 + 3.0 * mean * cells / REYNOLDS;
        let across = |times: f64| (times * cells).round();
        let extent = [across(LENGTH), across(HEIGHT), f64::from(LAYERS)];
        let mut scene = tank::scene(extent.map(|length| length as u32), tau)?;
        let height = extent[1];
        let profile = format!("{} * y * ({height} - y)", 4.0 * SPEED / (height * height));
        let mut stream = numbers([0.0; 3]);
        stream[0] = profile.parse::<Formula>()?;
        scene.initial.velocity = stream.clone();
        let faces = &mut scene.boundaries;
        faces.x_min = Boundary::Velocity {
            velocity: stream,
            turbulence: None,
        };
        faces.x_max = Boundary::Pressure {
            pressure: 0.0.into(),
            reflecting: false,
        };
        let wall = || Boundary::Wall {
            velocity: [0.0; 3],
            roughness: 0.0,
        };
        (faces.y_min, faces.y_max) = (wall(), wall());
        let at = [AXIS * cells, AXIS * cells, 0.5 * extent[2]];
        scene
            .blocks
            .push(block(prism(0.5 * cells, extent[2]), at, Motion::Driven));
        let steps = (SETTLE * cells / mean) as u64;
        scene.coupling.interval = (steps / 8) as u32;
        let mut tank = Tank::fill(context, &scene)?;
        tank.advance(steps / 8 * 8)?;
        let force = tank.load(0).flow.force.x / extent[2];
        let drag = force / (0.5 * mean * mean * cells);
        let trial = tank.trial("cylinder in a channel, Re 20");
        records.push(trial.relative(format!("C_d, D = {size}"), drag, DRAG, limit));
    }
    Ok(records)
}

/// A prism along z whose section has the area of a circle.
fn prism(radius: f64, length: f64) -> BlockShape {
    let turn = TAU / f64::from(SIDES);
    let outer = radius * (turn / turn.sin()).sqrt();
    let corner = |n: u32| (f64::from(n) * turn).sin_cos();
    let corners = (0..SIDES).map(corner);
    BlockShape::Vertices {
        vertices: corners
            .flat_map(|(sin, cos)| [-0.5, 0.5].map(|end| [outer * cos, outer * sin, end * length]))
            .collect(),
    }
}
