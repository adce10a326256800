//! How the drag of a cube swings as its faces cross cells, over resolution and relaxation time.

use crate::picture::{Chart, Curve, Mark, Measure};
use crate::validate::{
    Outcome, Stand,
    tank::{self, Tank, block},
};
use riprap::{
    formula::Formula,
    scene::{BlockShape, Motion},
};

/// Of the cube, cells a step: a cell in 25 steps.
const SPEED: f64 = 0.04;
/// Steps in which a face crosses a cell.
const CROSSING: usize = 25;
/// Time in which it gets there, over the length of the tank in cells: in which sound goes along it four times.
const RAMP: f64 = 7.0;
/// Cells on the way before it counts, and those that count.
const BEFORE: u64 = 4;
const COUNTED: usize = 4;

/// A cube along the grid through fluid at rest: its front covers whole layers of cells at once, which is the worst way
/// to go.
pub fn run(stand: &Stand) -> Outcome {
    let sizes: &[u32] = match (stand.full, stand.software) {
        (true, false) => &[5, 10, 20, 40],
        (true, true) => &[5, 10, 20],
        (false, _) => &[5, 10],
    };
    let (mut records, mut curves, mut table) = (Vec::new(), Vec::new(), Vec::new());
    for &size in sizes {
        let mut points = Vec::new();
        for tau in [0.55, 0.6, 0.8, 1.0, 1.5] {
            let mut scene = tank::scene([4 * size + 12, 3 * size, 3 * size], tau)?;
            let edge = f64::from(size);
            let shape = BlockShape::Box { size: [edge; 3] };
            let middle = 1.5 * edge + 0.2;
            let mut cube = block(shape, [edge + 0.3, middle, middle + 0.1], Motion::Driven);
            // A sudden start would send a sound round the tank that swings more than all else.
            let ramp = (RAMP * f64::from(4 * size + 12)).ceil();
            let speed = format!("{SPEED}*0.5*(1 - cos(pi*min(t/{ramp}, 1)))");
            cube.velocity = [speed.parse()?, Formula::number(0.0), Formula::number(0.0)];
            scene.blocks.push(cube);
            // Each step by itself: what a block feels is the mean of two.
            scene.coupling.average = false;
            let mut tank = Tank::fill(stand, &scene)?;
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
            // Of each crossing, so that a drag that changes slowly does not count.
            let swing = load.chunks_exact(CROSSING).map(|one| {
                let low = one.iter().copied().fold(f64::INFINITY, f64::min);
                let high = one.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                (high - low) / mean
            });
            let swing = swing.fold(0.0, f64::max);
            let trial = tank.trial(&format!("cube of {size}"));
            let of = format!("D = {size}, τ = {tau}");
            records.push(trial.report(format!("largest jump of a step / mean drag, {of}"), jump));
            let quantity = format!("swing of what it feels in a crossing / mean drag, {of}");
            records.push(trial.report(quantity, swing));
            points.push([tau, 100.0 * swing]);
            table.push([edge, tau, 100.0 * jump, 100.0 * swing]);
        }
        curves.push(Curve {
            name: format!("D = {size}"),
            points,
            mark: Mark::LinePoints,
        });
    }
    let chart = Chart::profile(
        "Swing of the drag of a cube as its faces cross cells",
        Measure::linear("relaxation time τ", ""),
        Measure::linear("swing / mean drag", "%"),
        curves,
    );
    stand.draw("solids_spike", &chart)?;
    let heads = ["edge", "tau", "jump_percent", "swing_percent"];
    stand.write_table("solids_spike", heads, &table)?;
    Ok(records)
}
