//! Cubes on a bed under a turbulent stream of water, at the viscosity of water: fixed, and carried along.

use super::{Cell, Map, Outcome, Sink};
use crate::validate::{CaseContext, tank::Tank};
use riprap::scene::{Motion, Scene, WallModel};
use std::path::Path;

/// The map.
pub const MAP: Map = Map {
    name: "bed",
    title: "Cubes of 8 cells on a bed, water at 2 m/s, viscosity 1e-6 m²/s, WALE",
    x: "mean velocity, cells per step",
    y: "cubes",
    short: "2 models, 2 velocities, fixed and free cubes, 4000 steps",
    full: "2 models, 2 velocities, fixed and free cubes, 100 000 steps",
    run,
};

/// The panels.
const MODELS: [(&str, WallModel); 2] = [
    ("no wall model", WallModel::None),
    ("wall model", WallModel::WernerWengle),
];
const VELOCITY: [f64; 2] = [0.05, 0.1];
/// Mean velocity over the bed in `bed.toml`, m/s.
const STREAM: f64 = 2.0;
/// Largest speed over the mean velocity that a stream around cubes can have: 1.2 by the cubes, 1.2 by the profile and 1.5 at edges
/// are 2.2; more in a vortex.
const FASTEST: f64 = 3.0;
const LOOKS: u64 = 40;

fn run(context: &CaseContext, sink: &mut Sink) -> anyhow::Result<()> {
    let steps = if context.full { 100_000 } else { 4000 };
    for (name, model) in MODELS {
        for motion in [Motion::Fixed, Motion::Free] {
            for velocity in VELOCITY {
                let mut scene = scene(motion, velocity)?;
                scene.numerics.wall_model = model;
                let cubes = match motion {
                    Motion::Free => "free",
                    _ => "fixed",
                };
                let x = format!("{velocity}");
                let cell = Cell::new(MAP.name, name, cubes.into(), x, "largest max|u| / U");
                sink.add(measure(context, cell, &scene, steps)?)?;
            }
        }
    }
    Ok(())
}

/// `velocity`: cells per step.
fn scene(motion: Motion, velocity: f64) -> anyhow::Result<Scene> {
    let mut scene = Scene::from_toml(include_str!("bed.toml"), Path::new("."), "stress")?;
    scene.numerics.time_step = Some(velocity * scene.domain.cell / STREAM);
    for cube in &mut scene.blocks[1..] {
        cube.motion = motion;
    }
    Ok(scene)
}

fn measure(context: &CaseContext, cell: Cell, scene: &Scene, steps: u64) -> anyhow::Result<Cell> {
    let mut cell = cell.run(|cell| {
        let mut tank = Tank::fill(context, scene)?;
        cell.warned = super::warned(tank.simulation.advice());
        let (mut speed, mut of_cubes) = (0.0_f64, 0.0_f64);
        for _ in 0..LOOKS {
            let done = tank.advance(steps / LOOKS);
            cell.steps = tank.simulation.step();
            done?;
            speed = speed.max(tank.totals()?.max_speed / STREAM);
            for cube in 1..=2 {
                of_cubes = of_cubes.max(tank.pose(cube).velocity.length() / STREAM);
            }
            cell.value = Some(speed);
            cell.detail = format!("largest speed of a cube / U {of_cubes:.3}");
        }
        if speed > FASTEST {
            cell.outcome = Outcome::Unphysical;
        }
        Ok(())
    })?;
    cell.agrees = Some(cell.outcome.is_good() || !cell.warned.is_empty());
    Ok(cell)
}
