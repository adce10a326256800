//! A cube held on a bed of 30° in water that starts to run (Gardner & Sitar 2018, section 6.3): the drag until it is
//! let go, on two grids, and the momentum of the water. The bed is a block here, whose load is measured too: at a cell
//! Reynolds number of 10⁵ the bounce-back of the first layer of cells takes a hundred times the momentum that the
//! viscosity of water would, in proportion to the cell, and the sides of the cube feel the same.

use super::{
    super::{Outcome, Record, Stand},
    tank::{Tank, block},
};
use crate::picture::{Chart, Curve, Mark, Measure};
use riprap::scene::{Block, BlockShape, Boundary, Field, Motion, Probe, ProbePlace, Scene};
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
/// Thickness of the bed, cells, and how far it reaches beyond the period, m.
const BED: f64 = 2.0;
const BEYOND: f64 = 1.0;

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
        let depth = scene.domain.size[2];
        lay_bed(&mut scene);
        let history = measure(stand, &scene, depth)?;
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

/// A block under the water, followed by a probe so that its loads are summed. What is below it must not rub on what its
/// cells hold.
fn lay_bed(scene: &mut Scene) {
    let thick = BED * scene.domain.cell;
    let [x, y, _] = scene.domain.size;
    scene.domain.size[2] += thick;
    scene.domain.origin[2] -= thick;
    scene.boundaries.z_min = Boundary::FreeSlip;
    let shape = BlockShape::Box {
        size: [x + 2.0 * BEYOND, y + 2.0 * BEYOND, thick],
    };
    let place = [0.5 * x, 0.5 * y, -0.5 * thick];
    scene.blocks.push(Block {
        name: Some("bed".into()),
        ..block(shape, place, Motion::Fixed)
    });
    scene.probes.push(Probe {
        name: "bed".into(),
        place: ProbePlace::Block {
            block: "bed".into(),
            faces: false,
            safety: false,
        },
        fields: vec![Field::Pressure],
        every: None,
    });
}

/// Of water so deep (m).
fn measure(stand: &Stand, scene: &Scene, depth: f64) -> anyhow::Result<History> {
    let mut tank = Tank::fill(stand, scene)?;
    let units = *tank.simulation.units();
    let slope = scene.rock.gravity[0];
    let begin = tank.totals()?.momentum[0];
    let (mut drag, mut window) = (Vec::new(), Vec::new());
    let [mut impulse, mut friction] = [0.0; 2];
    while tank.simulation.time() < scene.coupling.hold - 0.5 * units.time_step {
        tank.advance(1)?;
        let [force, along] = [0, 1].map(|block| {
            let felt = tank.felt(block);
            felt.flow.force.x + felt.buoyancy.force.x
        });
        impulse += force * units.time_step;
        friction += along * units.time_step;
        window.push(force);
        if tank.simulation.time() >= WINDOW * (drag.len() + 1) as f64 {
            let mean = window.iter().sum::<f64>() / window.len() as f64;
            drag.push([tank.simulation.time(), mean]);
            window.clear();
        }
    }
    let time = tank.simulation.time();
    // What the slope pulls at is the water beside the block.
    let [x, y, _] = scene.domain.size;
    let water = scene.fluid.density * (x * y * depth - EDGE.powi(3));
    let pull = water * slope * time;
    let gained = tank.totals()?.momentum[0] - begin;
    let what = format!("{:.0} cells an edge", EDGE / units.cell);
    let trial = tank.trial(&what);
    let balance = (pull - impulse - friction - gained).abs() / impulse;
    let mut records = vec![
        trial.report(
            "drag at the end of the hold, N",
            drag.last().map_or(f64::NAN, |d| d[1]),
            None,
        ),
        trial.report(
            "momentum to the bed / to the block",
            friction / impulse,
            None,
        ),
        trial.at_most(
            "(pull − drag − friction − gain of momentum) / drag",
            balance,
            1e-2,
        ),
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
