//! A cube held on a bed of 30° in water that starts to flow (Gardner & Sitar 2018, section 6.3): the drag until the cube is
//! released, on three grids, and the momentum of the water. The bed is a block here, whose load is measured too. Both have the
//! wall model of the scene. Without it, at a cell Reynolds number of 10⁵, a layer of cells that starts along a wall loses the
//! momentum that 0.3 of a cell gains, whatever its viscosity, while the physical boundary layer is a thirtieth of a cell thick. The
//! cube is then effectively larger by as much, so that its drag is too large in proportion to the cell size, from the first step on.
//!
//! ```text
//!  u  │    __ ______   bounce-back at τ → ½: the first cell goes at 0.63 of the
//!     │   |             speed of the others, the second at 1.10, the third at
//!     │ __|             0.97: 0.3 of a cell stands still.
//!     └───┴───┴───┴──   cells from the wall
//! ```
//!
//! In the limit of zero cell size the drag would be the added mass of the cube between bed and surface times the acceleration
//! along the slope, until the flow separates at its edges.

use crate::validate::{
    CaseContext, Outcome, Record, Trial, fields,
    tank::{Tank, block},
};
use riprap::scene::{
    Block, BlockShape, Boundary, Field, Motion, Probe, ProbePlace, Scene, WallModel,
};
use std::path::Path;

/// The bundled scene, with 12 cells per edge.
const SCENE: &str = include_str!("../../../scenes/incline_flow.toml");
/// Cell sizes of the grids over that of the scene; the histories of the last two should agree.
const GRIDS: [f64; 3] = [1.5, 1.0, 0.5];
/// Added mass of the cube over the mass of the water in its place, from Laplace's equation in the scene's box with 8 to 40 cells
/// per edge: 0.8898, 0.8647, 0.8535, 0.8435, 0.8390, 0.8366, extrapolated with the order 4/3 that its edges leave.
const ADDED_MASS: f64 = 0.829;
/// Time before the flow has separated noticeably at the edges of the cube, s: the water has moved 6 mm.
const START: f64 = 0.05;
/// Averaging time of the loads, s: sound crosses the cube in a fifth of it.
const WINDOW: f64 = 0.025;
/// Displacement of the block that counts as its first motion, in edges.
const MOVED: f64 = 1e-3;
const EDGE: f64 = 0.2;
/// Thickness of the bed, cells, and its overhang beyond the period, m.
const BED: f64 = 2.0;
const BEYOND: f64 = 1.0;

/// Results on one grid.
struct History {
    /// End of each window, s, and the mean drag in it, N.
    drag: Vec<[f64; 2]>,
    records: Vec<Record>,
    /// Cell, m, and the mean drag at the start, N.
    start: [f64; 2],
}

/// Runs all grids, compares them, and extrapolates to zero cell size.
pub fn run(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    let mut drags = Vec::new();
    let mut starts = Vec::new();
    let mut push = 0.0;
    for ratio in GRIDS {
        let mut scene = Scene::from_toml(SCENE, Path::new("."), "incline_flow.toml")?;
        scene.domain.cell *= ratio;
        let depth = scene.domain.size[2];
        push = ADDED_MASS * scene.fluid.density * EDGE.powi(3) * scene.rock.gravity[0];
        lay_bed(&mut scene);
        let history = measure(context, &scene, depth)?;
        records.extend(history.records);
        starts.push(history.start);
        drags.push(history.drag);
    }
    let [coarse, fine] = [1, 2].map(|n: usize| &drags[n]);
    let pairs = || coarse.iter().zip(fine);
    let square: f64 = pairs().map(|([_, a], [_, b])| (a - b).powi(2)).sum();
    let whole: f64 = fine.iter().map(|[_, b]| b * b).sum();
    let difference = (square / whole).sqrt();
    if let Some(last) = records.last().cloned() {
        let trial = Trial {
            setup: "all grids".into(),
            cells: last.cells,
            steps: last.steps,
            seconds: last.seconds,
            ..Trial::default()
        };
        let quantity = "difference of the drag histories, r.m.s.";
        records.push(trial.at_most(quantity, difference, 5e-2));
        // Value at zero cell size of the least-squares line through the grids.
        let [x, y] = [0, 1].map(|axis| {
            let sum: f64 = starts.iter().map(|start: &[f64; 2]| start[axis]).sum();
            sum / starts.len() as f64
        });
        let points: Vec<_> = starts.iter().map(|start| (start[0], start[1])).collect();
        let without_cells = y - fields::slope(&points) * x;
        let quantity = "drag at the start, by a line through the grids where cells end, N";
        records.push(trial.relative(quantity, without_cells, push, 5e-2));
    }
    records.extend(without_wall_model(context)?);
    Ok(records)
}

/// Loads on bed and cube without the wall model, on the grid of the scene.
fn without_wall_model(context: &CaseContext) -> Outcome {
    let mut scene = Scene::from_toml(SCENE, Path::new("."), "incline_flow.toml")?;
    scene.numerics.wall_model = WallModel::None;
    let depth = scene.domain.size[2];
    lay_bed(&mut scene);
    let mut records = measure(context, &scene, depth)?.records;
    for record in &mut records {
        record.quantity += ", no wall model";
    }
    Ok(records)
}

/// Adds the bed as a block under the water, with a probe so that its loads are summed. The face below it slips, so
/// that it exerts no friction on the fluid in the cells of the bed.
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

/// Runs the scene, with water of depth `depth` (m).
fn measure(context: &CaseContext, scene: &Scene, depth: f64) -> anyhow::Result<History> {
    let mut tank = Tank::fill(context, scene)?;
    let units = *tank.units();
    let slope = scene.rock.gravity[0];
    let begin = tank.totals()?.momentum[0];
    let (mut drag, mut window) = (Vec::new(), Vec::new());
    let [mut impulse, mut friction] = [0.0; 2];
    let mut start = Vec::new();
    while tank.simulation.time() < scene.coupling.hold - 0.5 * units.time_step {
        tank.advance(1)?;
        let [force, along] = [0, 1].map(|block| {
            let load = tank.load(block);
            load.flow.force.x + load.buoyancy.force.x
        });
        impulse += force * units.time_step;
        friction += along * units.time_step;
        window.push(force);
        if tank.simulation.time() <= START {
            start.push(force);
        }
        if tank.simulation.time() >= WINDOW * (drag.len() + 1) as f64 {
            let mean = window.iter().sum::<f64>() / window.len() as f64;
            drag.push([tank.simulation.time(), mean]);
            window.clear();
        }
    }
    let time = tank.simulation.time();
    // The pull of the slope acts on the water outside the cube.
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
        ),
        trial.report("momentum to the bed / to the block", friction / impulse),
        trial.report(
            "momentum to the bed / gain of a layer of cells",
            friction / (scene.fluid.density * x * y * units.cell * slope * time),
        ),
        trial.at_most(
            "(pull − drag − friction − gain of momentum) / drag",
            balance,
            1e-2,
        ),
    ];
    let begin = tank.pose(0).centre;
    while tank.simulation.time() < scene.run.duration.unwrap_or_default()
        && (tank.pose(0).centre - begin).length() < MOVED * EDGE
    {
        tank.advance(1)?;
    }
    let moved = tank.simulation.time() - time;
    records.push(tank.trial(&what).report("first motion after it, s", moved));
    let mean = start.iter().sum::<f64>() / start.len() as f64;
    records.push(trial.report("drag at the start, N", mean));
    Ok(History {
        drag,
        records,
        start: [units.cell, mean],
    })
}
