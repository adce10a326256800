//! A cube that crosses the grid: fluid that moves with it must not notice.

use crate::validate::{
    Outcome, Stand,
    tank::{self, Tank, block, numbers, turn},
};
use glam::DVec3;
use riprap::scene::{BlockShape, Motion, Scene};

const CUBE: f64 = 8.0;
/// Off all axes, so that edges and corners cross the cells too.
const VELOCITY: [f64; 3] = [0.05, 0.03, 0.02];
/// The fastest side crosses five cells.
const STEPS: u64 = 100;

fn cube(cells: [u32; 3], tau: f64, velocity: [f64; 3], turned: bool) -> anyhow::Result<Scene> {
    let mut scene = tank::scene(cells, tau)?;
    let shape = BlockShape::Box { size: [CUBE; 3] };
    let mut cube = block(shape, [8.3, 8.2, 8.1], Motion::Driven);
    cube.velocity = numbers(velocity);
    if turned {
        cube.rotation = turn(1);
    }
    scene.blocks.push(cube);
    // Each step by itself.
    scene.coupling.average = false;
    Ok(scene)
}

/// Forces of each step.
fn forces(tank: &mut Tank<'_>, steps: u64) -> anyhow::Result<Vec<DVec3>> {
    let mut all = Vec::new();
    for _ in 0..steps {
        tank.advance(1)?;
        all.push(tank.load(0).flow.force);
    }
    Ok(all)
}

/// In fluid that moves as the cube does, and in fluid at rest.
pub fn run(stand: &Stand) -> Outcome {
    let mut records = Vec::new();
    let scale = DVec3::from(VELOCITY).length_squared() * CUBE * CUBE;
    for (tau, turned) in [(0.52, false), (0.52, true), (1.0, true)] {
        let mut scene = cube([32, 24, 24], tau, VELOCITY, turned)?;
        scene.initial.velocity = numbers(VELOCITY);
        let mut tank = Tank::fill(stand, &scene)?;
        let found = forces(&mut tank, STEPS)?;
        let mean = found.iter().sum::<DVec3>().length() / found.len() as f64;
        let most = found.iter().map(|f| f.length()).fold(0.0, f64::max);
        let how = if turned { "turned" } else { "along the grid" };
        let trial = tank.trial(&format!("co-moving, {how}"));
        let quantity = format!("mean force / ρU²D², τ = {tau}, {how}");
        records.push(trial.at_most(quantity, mean / scale, 1e-3));
        records.push(trial.at_most("largest force of a step / ρU²D²", most / scale, 1e-3));
    }
    for turned in [false, true] {
        // 8 cells on the way, the last four of which count.
        let scene = cube([48, 24, 24], 0.6, [0.04, 0.0, 0.0], turned)?;
        let mut tank = Tank::fill(stand, &scene)?;
        tank.advance(STEPS)?;
        let found = forces(&mut tank, STEPS)?;
        let trial = tank.trial("through fluid at rest");
        let mean = found.iter().map(|f| f.x).sum::<f64>() / found.len() as f64;
        let jump = |pair: &[DVec3]| (pair[1].x - pair[0].x).abs();
        let spike = found.windows(2).map(jump).fold(0.0, f64::max) / mean.abs();
        let how = if turned { "turned" } else { "along the grid" };
        let quantity = format!("largest jump of the drag / its mean, {how}");
        records.push(trial.report(quantity, spike));
    }
    Ok(records)
}
