//! Runs that are cut twenty times and go on from files, beside the same ones uncut.

use super::{Cell, Map, Outcome, Sink};
use crate::validate::Stand;
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

const FLOW: &str = r#"
[domain]
size = [24, 16, 16]
cell = 1
[fluid]
density = 1
viscosity = 0.01
[numerics]
time_step = 1
velocity_scale = 0.08
eddy_viscosity = "wale"
[boundaries]
x_min = { kind = "velocity", velocity = ["0.04*(1 + 0.5*sin(0.1*t))", 0, 0] }
x_max = { kind = "pressure" }
y_min = { kind = "wall" }
y_max = { kind = "wall" }
[coupling]
interval = 3
[rock]
gravity = [0, -2e-4, 0]
[run]
steps = 1
[[materials]]
name = "rock"
density = 2.65
normal_stiffness = 0.5
friction = 30
[[blocks]]
kind = "box"
size = [5, 5, 5]
position = [9, 6, 8]
rotation = { axis = [1, 2, 3], angle = 30 }
[[blocks]]
kind = "sphere"
radius = 2.5
position = [15, 4, 6]
spin = [0, 0, 0.01]
"#;

const ROCK: &str = r#"
[run]
duration = 1
[[materials]]
name = "rock"
density = 2650
normal_stiffness = 1e8
friction = 35
damping = 0.2
[[blocks]]
name = "floor"
kind = "box"
size = [20, 20, 1]
position = [0, 0, -0.5]
motion = "fixed"
[[blocks]]
kind = "box"
size = [1, 1, 1]
position = [0, 0, 0.6]
repeat = { count = 6, step = [0.1, 0.03, 1.05] }
"#;

const WATER: &str = r#"
[domain]
size = [1, 0.1, 0.6]
[fluid]
acceleration = [0, 0, -9.81]
[particles]
spacing = 0.025
plane = true
[boundaries]
x_min = { kind = "wall" }
x_max = { kind = "wall" }
z_min = { kind = "wall" }
z_max = { kind = "open" }
[[water]]
kind = "box"
size = [0.4, 0.1, 0.4]
position = [0.2, 0.05, 0.2]
[[materials]]
name = "rock"
density = 2650
normal_stiffness = 1e9
friction = 35
damping = 0.2
[[blocks]]
name = "slab"
kind = "box"
size = [0.2, 0.1, 0.1]
position = [0.2, 0.05, 0.05]
[[blocks]]
name = "stone"
kind = "box"
size = [0.1, 0.1, 0.1]
position = [0.3, 0.05, 0.47]
rotation = { axis = [0, 1, 0], angle = 20 }
[run]
duration = 1
"#;

fn run(stand: &Stand, sink: &mut Sink) -> anyhow::Result<()> {
    // Not a multiple of the exchanges' interval, and odd.
    let part = |n: u64| if stand.full { 51 } else { 3 + n % 2 };
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
        let whole = run_in_parts(stand, &scene, &file, &[steps])?;
        let parts: Vec<u64> = (0..CUTS).map(part).collect();
        let cut = run_in_parts(stand, &scene, &file, &parts)?;
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

/// Makes everything anew for each part, continues from the file, writes the file; its bytes at the end.
fn run_in_parts(
    stand: &Stand,
    scene: &Scene,
    file: &Path,
    parts: &[u64],
) -> anyhow::Result<Vec<u8>> {
    for (n, steps) in parts.iter().enumerate() {
        let made = Simulation::new(&stand.device, &stand.queue, scene);
        let mut simulation = stand.drive("the kernels", made)??;
        if n > 0 {
            simulation.restore(&Checkpoint::read(file)?)?;
        }
        stand.drive("the steps", simulation.advance(*steps))??;
        let state = stand.drive("the state", simulation.checkpoint())??;
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
