//! Runs that are interrupted twenty times and continued from files, compared with uninterrupted ones.

use super::{Cell, Map, Outcome, Sink};
use crate::validate::CaseContext;
use riprap::{
    scene::Scene,
    simulation::{Simulation, checkpoint::Checkpoint},
};
use std::{path::Path, time::Instant};

/// The map.
pub const MAP: Map = Map {
    name: "restarts",
    title: "Runs cut and continued from files, against the uncut ones",
    x: "",
    y: "",
    short: "20 cuts, 3 or 4 steps apart",
    full: "20 cuts, 51 steps apart",
    run,
};

const CUTS: u64 = 20;

const FLOW: &str = include_str!("restart_flow.toml");
const ROCK: &str = include_str!("restart_rock.toml");
const WATER: &str = include_str!("restart_water.toml");

fn run(context: &CaseContext, sink: &mut Sink) -> anyhow::Result<()> {
    // Odd in the full form, alternately odd and even in the short one.
    let part = |n: u64| if context.full { 51 } else { 3 + n % 2 };
    let file = sink.folder().join("restart.state");
    let scenes = [
        ("blocks in a flow", FLOW),
        ("dry blocks", ROCK),
        ("free water with blocks", WATER),
    ];
    for (name, text) in scenes {
        let begin = Instant::now();
        let scene = Scene::from_toml(text, Path::new("."), "stress")?;
        let steps: u64 = (0..CUTS).map(part).sum();
        let whole = run_in_parts(context, &scene, &file, &[steps])?;
        let parts: Vec<u64> = (0..CUTS).map(part).collect();
        let cut = run_in_parts(context, &scene, &file, &parts)?;
        let differ = super::bytes_that_differ(&whole, &cut);
        let quantity = "bytes of the state that differ at the end";
        let (y, x) = (name.into(), "bytes that differ".into());
        sink.add(Cell {
            outcome: match differ {
                0 => Outcome::Ended,
                _ => Outcome::OverLimit,
            },
            value: Some(differ as f64),
            steps,
            seconds: begin.elapsed().as_secs_f64(),
            detail: format!("{CUTS} cuts, {} bytes", whole.len()),
            ..Cell::new(MAP.name, "", y, x, quantity)
        })?;
    }
    std::fs::remove_file(&file)?;
    Ok(())
}

/// Creates a new simulation for each part, continues from the file and writes it. Returns its bytes at the end.
fn run_in_parts(
    context: &CaseContext,
    scene: &Scene,
    file: &Path,
    parts: &[u64],
) -> anyhow::Result<Vec<u8>> {
    for (n, steps) in parts.iter().enumerate() {
        let made = Simulation::new(&context.device, &context.queue, scene);
        let mut simulation = context.drive("the kernels", made)??;
        if n > 0 {
            simulation.restore(&Checkpoint::read(file)?)?;
        }
        context.drive("the steps", simulation.advance(*steps))??;
        let state = context.drive("the state", simulation.checkpoint())??;
        state.write(file)?;
    }
    Ok(std::fs::read(file)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_cut_is_a_scene() {
        for text in [FLOW, ROCK, WATER] {
            let scene = Scene::from_toml(text, Path::new("."), "stress");
            assert!(scene.is_ok(), "{}", scene.unwrap_err());
        }
    }
}
