//! A cube that crosses the grid: co-moving fluid must not be disturbed; in fluid at rest the drag fluctuates.

use crate::validate::{
    CaseContext, Method, Outcome,
    tank::{self, Tank, block, numbers, turn},
};
use glam::DVec3;
use riprap::{
    formula::Formula,
    scene::{BlockShape, Motion, Scene},
};

const CUBE: f64 = 8.0;
/// Oblique to all axes, so that edges and corners cross the cells too.
const VELOCITY: [f64; 3] = [0.05, 0.03, 0.02];
/// The fastest face crosses five cells.
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
    // Forces of single steps, not averaged.
    scene.coupling.average = Some(false);
    Ok(scene)
}

/// Force at each step.
fn forces(tank: &mut Tank<'_>, steps: u64) -> anyhow::Result<Vec<DVec3>> {
    let mut all = Vec::new();
    for _ in 0..steps {
        tank.advance(1)?;
        all.push(tank.load(0).flow.force);
    }
    Ok(all)
}

/// Runs the cube in fluid that moves with it, and in fluid at rest.
pub fn run(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    let scale = DVec3::from(VELOCITY).length_squared() * CUBE * CUBE;
    for (tau, turned) in [(0.52, false), (0.52, true), (1.0, true)] {
        let mut scene = cube([32, 24, 24], tau, VELOCITY, turned)?;
        scene.initial.velocity = numbers(VELOCITY);
        let mut tank = Tank::fill(context, &scene)?;
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
        // A path of 8 cells, the last four of which count.
        let scene = cube([48, 24, 24], 0.6, [0.04, 0.0, 0.0], turned)?;
        let mut tank = Tank::fill(context, &scene)?;
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

/// Speed of the cube, cells per step: a cell in 25 steps.
const SPEED: f64 = 0.04;
/// Steps in which a face crosses a cell.
const CROSSING: usize = 25;
/// Duration of the acceleration over the length of the tank in cells: sound travels along the tank four times.
const RAMP: f64 = 7.0;
/// Cells crossed before the measurement, and cells measured.
const BEFORE: u64 = 4;
const COUNTED: usize = 4;

/// Fluctuation of the drag of a cube as its faces cross cells, over resolution and relaxation time. The cube moves along the grid
/// through fluid at rest: its front covers whole layers of cells at once, which is the worst case.
pub fn swing(context: &CaseContext) -> Outcome {
    let sizes: &[u32] = match (context.full, context.software) {
        (true, false) => &[5, 10, 20, 40],
        (true, true) => &[5, 10, 20],
        (false, _) => &[5, 10],
    };
    let mut records = Vec::new();
    let methods = [Method::DEFAULT, Method::STANDARD_WEIGHT];
    for (&size, method) in sizes.iter().flat_map(|size| methods.map(|m| (size, m))) {
        for tau in [0.55, 0.6, 0.8, 1.0, 1.5] {
            let mut scene = tank::scene([4 * size + 12, 3 * size, 3 * size], tau)?;
            let edge = f64::from(size);
            let shape = BlockShape::Box { size: [edge; 3] };
            let middle = 1.5 * edge + 0.2;
            let mut cube = block(shape, [edge + 0.3, middle, middle + 0.1], Motion::Driven);
            // A sudden start would send a sound wave round the tank that outweighs all else.
            let ramp = (RAMP * f64::from(4 * size + 12)).ceil();
            let speed = format!("{SPEED}*0.5*(1 - cos(pi*min(t/{ramp}, 1)))");
            cube.velocity = [speed.parse()?, Formula::number(0.0), Formula::number(0.0)];
            scene.blocks.push(cube);
            // Forces of single steps: the load on a block is the mean of two.
            scene.coupling.average = Some(false);
            method.choose(&mut scene);
            let mut tank = Tank::fill(context, &scene)?;
            tank.advance(ramp as u64 + BEFORE * CROSSING as u64)?;
            let mut drag = Vec::new();
            for _ in 0..COUNTED * CROSSING + 1 {
                tank.advance(1)?;
                drag.push(-tank.load(0).flow.force.x);
            }
            let load: Vec<f64> = drag.windows(2).map(|two| 0.5 * (two[0] + two[1])).collect();
            let mean = load.iter().sum::<f64>() / load.len() as f64;
            let jump = drag.windows(2).map(|two| (two[1] - two[0]).abs());
            let jump = jump.fold(0.0, f64::max) / mean;
            // Per crossing, so that slow changes of the drag do not count.
            let swing = load.chunks_exact(CROSSING).map(|one| {
                let low = one.iter().copied().fold(f64::INFINITY, f64::min);
                let high = one.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                (high - low) / mean
            });
            let swing = swing.fold(0.0, f64::max);
            let trial = tank.trial(&format!("cube of {size}"));
            let of = format!("D = {size}, τ = {tau}, {}", method.name);
            records.push(trial.report(format!("largest jump of a step / mean drag, {of}"), jump));
            let quantity = format!("swing of what it feels in a crossing / mean drag, {of}");
            records.push(trial.report(quantity, swing));
        }
    }
    Ok(records)
}
