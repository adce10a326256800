//! A cube held on a bed of 30° in water that starts to run (Gardner & Sitar 2018, section 6.3): the drag until it is
//! let go, on two grids, and the momentum of the water.

use super::{
    super::{Outcome, Record, Stand},
    tank::Tank,
};
use crate::picture::{Chart, Curve, Mark, Measure};
use riprap::scene::Scene;
use std::path::Path;

/// The scene that ships, with 12 cells an edge.
const SCENE: &str = include_str!("../../../scenes/incline_flow.toml");
/// Cells of the two grids over the scene's.
const GRIDS: [f64; 2] = [1.0, 0.5];
/// Over this time loads are averaged, s: sound crosses the cube in a fifth of it.
const WINDOW: f64 = 0.025;
/// Way of the block that counts as its first motion, in edges.
const MOVED: f64 = 1e-3;
const EDGE: f64 = 0.2;

/// What a grid gives.
struct History {
    /// End of each window, s, and the mean drag in it, N.
    drag: Vec<[f64; 2]>,
    records: Vec<Record>,
}

/// On both grids, and how they differ.
pub fn run(stand: &Stand) -> Outcome {
    let mut records = Vec::new();
    let mut curves: Vec<Curve> = Vec::new();
    for ratio in GRIDS {
        let mut scene = Scene::from_toml(SCENE, Path::new("."), "incline_flow.toml")?;
        scene.domain.cell *= ratio;
        let history = measure(stand, &scene)?;
        records.extend(history.records);
        curves.push(Curve {
            name: format!("{:.0} cells an edge", EDGE / scene.domain.cell),
            points: history.drag,
            mark: Mark::Line,
        });
    }
    let [coarse, fine] = [0, 1].map(|n| &curves[n].points);
    let pairs = || coarse.iter().zip(fine);
    let square: f64 = pairs().map(|([_, a], [_, b])| (a - b).powi(2)).sum();
    let whole: f64 = fine.iter().map(|[_, b]| b * b).sum();
    let difference = (square / whole).sqrt();
    if let Some(last) = records.last().cloned() {
        let trial = super::super::Trial {
            setup: "both grids".into(),
            cells: last.cells,
            steps: last.steps,
            seconds: last.seconds,
            ..super::super::Trial::default()
        };
        let quantity = "difference of the drag histories, r.m.s.";
        records.push(trial.at_most(quantity, difference, 5e-2));
    }
    if let Some(folder) = &stand.pictures {
        let chart = Chart::profile(
            "Drag on a cube held in water that starts down a slope of 30°",
            Measure::linear("time", "s"),
            Measure::linear("force along the slope", "N"),
            curves,
        );
        chart.draw(&folder.join("solids_incline_flow.png"))?;
    }
    Ok(records)
}

fn measure(stand: &Stand, scene: &Scene) -> anyhow::Result<History> {
    let mut tank = Tank::fill(stand, scene)?;
    let units = *tank.simulation.units();
    let slope = scene.rock.gravity[0];
    let begin = tank.totals()?.momentum[0];
    let (mut drag, mut window, mut impulse) = (Vec::new(), Vec::new(), 0.0);
    while tank.simulation.time() < scene.coupling.hold - 0.5 * units.time_step {
        tank.advance(1)?;
        let felt = tank.felt(0);
        let force = felt.flow.force.x + felt.buoyancy.force.x;
        impulse += force * units.time_step;
        window.push(force);
        if tank.simulation.time() >= WINDOW * (drag.len() + 1) as f64 {
            let mean = window.iter().sum::<f64>() / window.len() as f64;
            drag.push([tank.simulation.time(), mean]);
            window.clear();
        }
    }
    let time = tank.simulation.time();
    // What the slope pulls at is the water beside the block. The bed's friction is that of water at some m/s over
    // the half cell beside it: 1e-4 of the rest.
    let [x, y, z] = scene.domain.size;
    let water = scene.fluid.density * (x * y * z - EDGE.powi(3));
    let pull = water * slope * time;
    let gained = tank.totals()?.momentum[0] - begin;
    let what = format!("{:.0} cells an edge", EDGE / units.cell);
    let trial = tank.trial(&what);
    let balance = (pull - impulse - gained).abs() / impulse;
    let mut records = vec![
        trial.report(
            "drag at the end of the hold, N",
            drag.last().map_or(f64::NAN, |d| d[1]),
            None,
        ),
        trial.at_most("(pull − drag − gain of momentum) / drag", balance, 1e-2),
    ];
    let start = tank.pose(0)?.centre;
    while tank.simulation.time() < scene.run.duration.unwrap_or_default()
        && (tank.pose(0)?.centre - start).length() < MOVED * EDGE
    {
        tank.advance(1)?;
    }
    let moved = tank.simulation.time() - time;
    records.push(
        tank.trial(&what)
            .report("first motion after it, s", moved, None),
    );
    Ok(History { drag, records })
}
