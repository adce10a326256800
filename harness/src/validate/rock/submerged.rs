//! A deformable cube under the pressure of water: its stress is minus the pressure at its centroid.

use crate::validate::{
    CaseContext, Outcome,
    tank::{self, GRAVITY, Tank},
};
use glam::DMat3;
use riprap::scene::Scene;
use std::path::Path;

/// Pressure in the lattice, Pa.
const PRESSURE: f64 = 1e-3;
/// Cells across the cube.
const CELLS: f64 = 6.0;
const STEPS: u64 = 200;

/// Edge of the cube in free water and depth of its centroid, m.
const EDGE: f64 = 0.3;
const DEPTH: f64 = 0.3;
/// Readings of free water, 0.02 s apart: pressure oscillates by 1 %.
const LOOKS: u32 = 10;

/// The cube, held at its centroid so that it cannot turn.
fn cube(edge: f64, position: [f64; 3], angle: f64) -> String {
    let arm = 0.3 * edge;
    format!(
        r#"
        [[blocks]]
        kind = "box"
        size = [{edge}, {edge}, {edge}]
        position = {position:?}
        rotation = {{ axis = [1, 2, 3], angle = {angle} }}
        deformable = true
        fixed_points = [
            {{ point = [0, 0, 0] }},
            {{ point = [{arm}, 0, 0], axes = ["y", "z"] }},
            {{ point = [0, {arm}, 0], axes = ["z"] }},
        ]
        "#
    )
}

/// A closed tank of fluid under pressure, which also fills the cube.
fn pressed(angle: f64) -> anyhow::Result<Scene> {
    let text = format!(
        r#"
        domain = {{ size = [16, 16, 16], cell = 1 }}
        fluid = {{ density = 1, viscosity = 0.1 }}
        numerics = {{ time_step = 1 }}
        initial = {{ pressure = {PRESSURE} }}
        rock = {{ gravity = [0, 0, 0] }}
        run = {{ steps = 1 }}
        [[materials]]
        name = "rock"
        density = 2
        normal_stiffness = 1
        friction = 30
        youngs_modulus = 10
        {}
        "#,
        cube(CELLS, [8.2, 8.1, 7.9], angle)
    );
    let mut scene = Scene::from_toml(&text, Path::new("."), "tank")?;
    tank::close(&mut scene);
    Ok(scene)
}

/// A tank of free water.
fn pool(spacing: f64) -> anyhow::Result<Scene> {
    let text = format!(
        r#"
        domain = {{ size = [0.6, 0.6, 0.75] }}
        fluid = {{ acceleration = [0, 0, -{GRAVITY}] }}
        rock = {{ gravity = [0, 0, -{GRAVITY}] }}
        particles = {{ spacing = {spacing} }}
        run = {{ steps = 1 }}
        [boundaries]
        x_min = {{ kind = "wall" }}
        x_max = {{ kind = "wall" }}
        y_min = {{ kind = "wall" }}
        y_max = {{ kind = "wall" }}
        z_min = {{ kind = "wall" }}
        z_max = {{ kind = "open" }}
        [[water]]
        kind = "box"
        size = [0.6, 0.6, 0.6]
        position = [0.3, 0.3, 0.3]
        [[materials]]
        name = "rock"
        density = 2500
        normal_stiffness = 1e7
        friction = 35
        youngs_modulus = 1e8
        {}
        "#,
        cube(EDGE, [0.3, 0.3, 0.6 - DEPTH], 0.0)
    );
    Ok(Scene::from_toml(&text, Path::new("."), "pool")?)
}

/// The stress of the cube, Pa.
fn stress(tank: &Tank<'_>) -> DMat3 {
    let rock = tank.simulation.rock().expect("a tank with a block");
    rock.blocks().stress(0).expect("a deformable block")
}

/// Largest entry of a stress beside that of a uniform pressure, over the pressure.
fn unlike(stress: DMat3, pressure: f64) -> f64 {
    let rest = stress + DMat3::IDENTITY * pressure;
    let entries = rest.to_cols_array().map(f64::abs);
    entries.into_iter().fold(0.0, f64::max) / pressure
}

/// The cube on the lattice along the grid and turned, and in free water at two spacings.
pub fn run(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    for angle in [0.0, 30.0] {
        let mut tank = Tank::fill(context, &pressed(angle)?)?;
        tank.advance(STEPS)?;
        let what = format!("error of the stress / pressure, {CELLS} cells, turned by {angle}°");
        let trial = tank.trial("cube in a closed tank");
        records.push(trial.at_most(what, unlike(stress(&tank), PRESSURE), 0.002));
    }
    for (spacings, limit) in [(6.0, 0.04), (10.0, 0.02)] {
        let mut pool = Tank::fill(context, &pool(EDGE / spacings)?)?;
        let mut sum = DMat3::ZERO;
        for look in 1..=LOOKS {
            pool.advance_to(0.02 * f64::from(look))?;
            sum += stress(&pool);
        }
        let mean = sum * (1.0 / f64::from(LOOKS));
        let what = format!("error of the stress / pressure, {spacings} spacings of free water");
        let trial = pool.trial("cube in a pool");
        records.push(trial.at_most(what, unlike(mean, 1000.0 * GRAVITY * DEPTH), limit));
    }
    Ok(records)
}
