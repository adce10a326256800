//! A block at rest in a closed tank: the load on it is ρVg and nothing else.

use crate::validate::{
    CaseContext, Outcome,
    tank::{self, Tank, block, numbers, turn},
};
use riprap::scene::{BlockShape, Motion, Scene};

/// Edges of tank and cube, cells.
const TANK: u32 = 32;
const CUBE: f64 = 16.0;
const GRAVITY: f64 = 1e-5;
/// By then the initial sound has decayed to 1e-3.
const STEPS: u64 = 240;

/// A cube near the middle of the tank, under gravity, optionally rotated against the grid.
fn cube(tau: f64, turned: bool, motion: Motion) -> anyhow::Result<Scene> {
    let mut scene = tank::scene([TANK; 3], tau)?;
    tank::close(&mut scene);
    scene.rock.gravity = [0.0, 0.0, -GRAVITY];
    let shape = BlockShape::Box { size: [CUBE; 3] };
    let mut cube = block(shape, [15.8, 16.3, 16.1], motion);
    if turned {
        cube.rotation = turn(1);
    }
    scene.blocks.push(cube);
    Ok(scene)
}

/// Buoyancy is ρVg at any viscosity, with gravity acting on fluid and rock or on the rock only.
pub fn archimedes(context: &CaseContext) -> Outcome {
    let runs = [
        (0.55, true, true),
        (0.8, true, true),
        (1.5, true, true),
        (0.8, false, true),
        (0.8, true, false),
    ];
    let weight = CUBE.powi(3) * GRAVITY;
    let mut records = Vec::new();
    for (tau, turned, heavy) in runs {
        let mut scene = cube(tau, turned, Motion::Driven)?;
        if heavy {
            scene.fluid.acceleration = numbers(scene.rock.gravity);
        }
        scene.coupling.interval = (STEPS / 8) as u32;
        let mut tank = Tank::fill(context, &scene)?;
        tank.advance(STEPS)?;
        let load = tank.load(0);
        let force = load.flow.force + load.buoyancy.force;
        let torque = load.flow.torque() + load.buoyancy.torque();
        let how = match (turned, heavy) {
            (true, true) => "turned",
            (false, _) => "along the grid",
            (_, false) => "turned, weightless water",
        };
        let trial = tank.trial(how);
        let quantity = format!("buoyancy / ρVg, τ = {tau}, {how}");
        records.push(trial.relative(quantity, force.z / weight, 1.0, 1e-2));
        let across = force.truncate().length() / weight;
        records.push(trial.at_most("force across / ρVg", across, 1e-2));
        let lever = torque.length() / (weight * CUBE);
        records.push(trial.at_most("torque / ρVgL", lever, 1e-3));
    }
    Ok(records)
}

/// A cube as heavy as water stays where it is.
pub fn neutral(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    for tau in [0.55, 1.0] {
        let mut scene = cube(tau, true, Motion::Free)?;
        scene.fluid.acceleration = numbers(scene.rock.gravity);
        let mut tank = Tank::fill(context, &scene)?;
        let start = tank.pose(0);
        tank.advance(STEPS)?;
        let end = tank.pose(0);
        let trial = tank.trial("neutral cube");
        // The distance that it would fall without water.
        let fall = 0.5 * GRAVITY * (STEPS as f64).powi(2);
        let way = (end.centre - start.centre).length() / fall;
        records.push(trial.at_most(format!("drift / (gt²/2), τ = {tau}"), way, 1e-2));
        let speed = end.velocity.length() / (GRAVITY * STEPS as f64);
        records.push(trial.at_most("speed / gt", speed, 1e-2));
    }
    Ok(records)
}
