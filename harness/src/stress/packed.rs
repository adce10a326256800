//! Eight cubes packed two by two by two in fast flow, over the gap between them.

use super::{Cell, Map, Outcome, Sink, tally::Peaks};
use crate::validate::{
    CaseContext,
    tank::{self, Tank, block, numbers},
};
use riprap::scene::{BlockShape, EddyViscosity, Motion, Scene};

/// The map.
pub const MAP: Map = Map {
    name: "packed",
    title: "Eight cubes of 8 cells in a stream that hits them at once, τ = 0.501, WALE",
    x: "Mach number of the stream",
    y: "gap, cells",
    short: "free and fixed, 4 gaps, 3 Mach numbers, 120 steps",
    full: "free and fixed, 6 gaps, 4 Mach numbers, 2000 steps",
    run,
};

const CELLS: [u32; 3] = [48, 32, 32];
const EDGE: f64 = 8.0;
const TAU: f64 = 0.501;
const RATIO: f64 = 2.65;
/// Normal stiffness of the contacts: the stream at Mach 0.3 presses them in by a hundredth of a cell.
const STIFFNESS: f64 = 1.0;
const GAP: [f64; 6] = [0.0, 0.1, 0.5, 1.0, 2.0, 4.0];
const SHORT_GAP: [f64; 4] = [0.0, 0.5, 1.0, 2.0];
/// The last one is the largest that the library accepts.
const MACH: [f64; 4] = [0.05, 0.1, 0.2, 0.3];
const SHORT_MACH: [f64; 3] = [0.1, 0.2, 0.3];
/// Rise of energy over the start that rounding, sound and the fluctuation of single loads do not explain.
const RISE: f64 = 1.05;
const LOOKS: u64 = 6;

fn run(context: &CaseContext, sink: &mut Sink) -> anyhow::Result<()> {
    let (gaps, machs): (&[f64], &[f64]) = match context.full {
        true => (&GAP, &MACH),
        false => (&SHORT_GAP, &SHORT_MACH),
    };
    let steps = if context.full { 2000 } else { 120 };
    for motion in [Motion::Free, Motion::Fixed] {
        for &gap in gaps {
            for &mach in machs {
                sink.add(measure(context, motion, gap, mach, steps)?)?;
            }
        }
    }
    Ok(())
}

fn scene(motion: Motion, gap: f64, speed: f64) -> anyhow::Result<Scene> {
    let mut scene = tank::scene(CELLS, TAU)?;
    scene.numerics.velocity_scale = Some(speed);
    scene.numerics.eddy_viscosity = EddyViscosity::Wale;
    scene.initial.velocity = numbers([speed, 0.0, 0.0]);
    scene.materials[0].density = RATIO;
    scene.materials[0].normal_stiffness = STIFFNESS;
    let middle = CELLS.map(|n| 0.5 * f64::from(n));
    for n in 0..8u8 {
        let side = |bit: u8| if n >> bit & 1 == 1 { 0.5 } else { -0.5 };
        let at = [0, 1, 2].map(|a| middle[usize::from(a)] + side(a) * (EDGE + gap));
        let shape = BlockShape::Box { size: [EDGE; 3] };
        scene.blocks.push(block(shape, at, motion));
    }
    Ok(scene)
}

fn measure(
    context: &CaseContext,
    motion: Motion,
    gap: f64,
    mach: f64,
    steps: u64,
) -> anyhow::Result<Cell> {
    let speed = mach / 3f64.sqrt();
    let panel = if motion == Motion::Free {
        "free"
    } else {
        "fixed"
    };
    let (y, x) = (format!("{gap}"), format!("{mach}"));
    let cell = Cell::new(MAP.name, panel, y, x, "largest max|u| / U₀");
    let scene = scene(motion, gap, speed)?;
    let mut cell = cell.run(|cell| {
        let mut tank = Tank::fill(context, &scene)?;
        cell.warned = super::warned(tank.simulation.advice());
        let peaks = Peaks::of(&mut tank, RATIO, [steps, LOOKS], cell)?;
        cell.value = Some(peaks.flow_speed / speed);
        cell.detail = format!("largest energy / that of the start {:.3}", peaks.energy);
        // A stream is faster around corners than far away, but it cannot have more energy than at the start.
        if peaks.energy > RISE {
            cell.outcome = Outcome::Unphysical;
        }
        Ok(())
    })?;
    cell.agrees = Some(cell.outcome.is_good() || !cell.warned.is_empty());
    Ok(cell)
}
