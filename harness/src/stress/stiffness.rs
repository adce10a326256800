//! Dry cubes that fall onto a floor and slide, over the stiffness of contacts and the length of a step.

use super::{Cell, Map, Outcome, Sink};
use crate::validate::{
    CaseContext,
    rock::{G, Rock, cuboid, floor, joint, setup},
};
use glam::DVec3;
use riprap::rock::{
    Block, Setup,
    law::{LARGEST_SHARE, USUAL_SHARE},
};
use std::time::Instant;

/// The map.
pub const MAP: Map = Map {
    name: "stiffness",
    title: "Three cubes of 1 m fall 5 cm onto a floor at 0.5 m/s along it",
    x: "step, s",
    y: "normal stiffness, Pa/m",
    short: "all of it, 0.3 s",
    full: "6 stiffnesses, 10 steps, 5 s",
    run,
};

const STIFFNESS: [f64; 6] = [1e6, 1e7, 1e8, 1e9, 1e10, 1e11];
const STEP: [f64; 10] = [1e-5, 3e-5, 1e-4, 2e-4, 4e-4, 7e-4, 1e-3, 2e-3, 4e-3, 1e-2];
/// Height of the fall, m.
const FALL: f64 = 0.05;
/// Limit on the energy error over the energy of the fall; the same as for the ledger of an avalanche.
const ENERGY: f64 = 0.01;

fn blocks(stiffness: f64) -> anyhow::Result<Setup> {
    let mut list = vec![floor(10.0)?];
    for n in 0..3 {
        let k = f64::from(n);
        // Not exactly above each other, so that corners and edges carry load too.
        let at = DVec3::new(0.2 * k, 0.05 * k, 0.5 + FALL + k * (1.0 + FALL));
        let mut cube = Block::new(format!("cube {n}"), cuboid(1.0, 1.0, 1.0)?, at);
        cube.velocity = DVec3::new(0.5, 0.0, 0.0);
        list.push(cube);
    }
    Ok(setup(list, joint(stiffness, 30.0)))
}

fn run(context: &CaseContext, sink: &mut Sink) -> anyhow::Result<()> {
    let time = if context.full { 5.0 } else { 0.3 };
    for stiffness in STIFFNESS {
        let usual = shortest(stiffness, time)?;
        for step in STEP {
            sink.add(measure(stiffness, step, usual, time)?)?;
        }
    }
    Ok(())
}

/// Shortest default step of the library, s, a tenth of 2/ω at the stiffest moment; `None` if blocks of this stiffness penetrate
/// too deeply.
fn shortest(stiffness: f64, time: f64) -> anyhow::Result<Option<f64>> {
    const PARTS: u32 = 60;
    let mut rock = Rock::new(blocks(stiffness)?, "")?;
    let mut step = f64::INFINITY;
    for _ in 0..PARTS {
        match rock.run(time / f64::from(PARTS)) {
            Ok(()) => step = step.min(rock.blocks.time_step()),
            Err(error) if error.is::<riprap::Error>() => return Ok(None),
            Err(other) => return Err(other),
        }
    }
    Ok(Some(step))
}

fn measure(stiffness: f64, step: f64, usual: Option<f64>, time: f64) -> anyhow::Result<Cell> {
    let begin = Instant::now();
    let mut setup = blocks(stiffness)?;
    setup.time_step = Some(step);
    let mut rock = Rock::new(setup, "")?;
    let ended = rock.run(time);
    let error = rock.energy_error() / (3.0 * rock.blocks.mass(1) * G * FALL);
    let (outcome, detail) = match ended {
        Ok(()) if error <= ENERGY => (Outcome::Ended, String::new()),
        // NaN fails too.
        Ok(()) => (
            Outcome::Unphysical,
            "the ledger of the energy does not close".into(),
        ),
        Err(failed) if failed.is::<riprap::Error>() => (Outcome::of(&failed), failed.to_string()),
        Err(other) => return Err(other),
    };
    let longest = usual.map(|usual| usual * LARGEST_SHARE / USUAL_SHARE);
    let warned = match (usual, longest) {
        (Some(_), Some(longest)) if step > longest => {
            format!("beyond the longest, {longest:.1e} s")
        }
        (Some(usual), _) if step > usual => format!("beyond the usual, {usual:.1e} s"),
        _ => String::new(),
    };
    let (y, x) = (format!("{stiffness:e}"), format!("{step:e}"));
    let quantity = "error of the energy / that of the fall";
    Ok(Cell {
        // A step that the library accepts must not lead to wrong motion; it reports when the step is too long for the present
        // contacts, or when blocks penetrate too deeply.
        agrees: Some(outcome != Outcome::Unphysical),
        value: outcome.is_good().then_some(error),
        outcome,
        steps: rock.blocks.steps(),
        warned,
        seconds: begin.elapsed().as_secs_f64(),
        detail,
        ..Cell::new(MAP.name, "", y, x, quantity)
    })
}
