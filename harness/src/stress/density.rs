//! A block thrown into fluid at rest: light blocks respond to their own wake, fast ones to sound.

use super::{Cell, Map, Outcome, Sink, tally::Peaks};
use crate::validate::{
    CaseContext,
    tank::{self, Tank, block, numbers, turn},
};
use riprap::scene::{BlockShape, Motion};

/// The map.
pub const MAP: Map = Map {
    name: "density",
    title: "Cube of 8 cells thrown into fluid at rest, τ = 0.55",
    x: "Mach number of the block",
    y: "density / that of the fluid",
    short: "3 densities and a driven block, 3 Mach numbers, 150 steps",
    full: "5 densities and a driven block, 4 Mach numbers, 1000 steps",
    run,
};

const CELLS: [u32; 3] = [40, 24, 24];
const EDGE: f64 = 8.0;
const TAU: f64 = 0.55;
const RATIO: [f64; 5] = [0.5, 1.0, 2.65, 5.0, 8.0];
const SHORT_RATIO: [f64; 3] = [0.5, 2.65, 8.0];
const MACH: [f64; 4] = [0.02, 0.05, 0.1, 0.2];
const SHORT_MACH: [f64; 3] = [0.02, 0.1, 0.2];
/// Rise of energy or speed over the start that rounding, sound and the fluctuation of single loads do not explain.
const RISE: f64 = 1.05;
/// Readings of the energy in a run.
const LOOKS: u64 = 10;

fn run(context: &CaseContext, sink: &mut Sink) -> anyhow::Result<()> {
    let (ratios, machs): (&[f64], &[f64]) = match context.full {
        true => (&RATIO, &MACH),
        false => (&SHORT_RATIO, &SHORT_MACH),
    };
    let steps = if context.full { 1000 } else { 150 };
    for &ratio in ratios {
        for &mach in machs {
            sink.add(measure(context, Some(ratio), mach, steps)?)?;
        }
    }
    for &mach in machs {
        sink.add(measure(context, None, mach, steps)?)?;
    }
    Ok(())
}

/// A free block with the density `ratio`, or a driven one.
fn measure(
    context: &CaseContext,
    ratio: Option<f64>,
    mach: f64,
    steps: u64,
) -> anyhow::Result<Cell> {
    let speed = mach / 3f64.sqrt();
    let mut scene = tank::scene(CELLS, TAU)?;
    scene.numerics.velocity_scale = Some(speed);
    let motion = match ratio {
        Some(ratio) => {
            scene.materials[0].density = ratio;
            Motion::Free
        }
        None => Motion::Driven,
    };
    let shape = BlockShape::Box { size: [EDGE; 3] };
    let mut cube = block(shape, CELLS.map(|n| 0.5 * f64::from(n)), motion);
    cube.velocity = numbers([speed, 0.0, 0.0]);
    cube.rotation = turn(1);
    scene.blocks.push(cube);
    let cell = Cell::new(
        MAP.name,
        "",
        ratio.map_or("driven".into(), |ratio| format!("{ratio}")),
        format!("{mach}"),
        "largest energy / that of the start; driven: largest max|u| / U₀",
    );
    let mut cell = cell.run(|cell| {
        let mut tank = Tank::fill(context, &scene)?;
        cell.warned = super::warned(tank.simulation.advice());
        let peaks = Peaks::of(&mut tank, ratio.unwrap_or(1.0), [steps, LOOKS], cell)?;
        let [of_block, of_flow] = [peaks.block_speed, peaks.flow_speed].map(|u| u / speed);
        cell.detail = format!("largest speed / U₀: block {of_block:.3}, fluid {of_flow:.3}");
        // A driven block gains energy from its drive.
        let free = ratio.is_some();
        cell.value = Some(if free { peaks.energy } else { of_flow });
        if free && (peaks.energy > RISE || of_block > RISE) {
            cell.outcome = Outcome::Unphysical;
        }
        Ok(())
    })?;
    let well = !matches!(cell.outcome, Outcome::Error(_) | Outcome::Unphysical);
    cell.agrees = Some(well || !cell.warned.is_empty());
    Ok(cell)
}
