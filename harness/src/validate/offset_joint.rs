//! The stagnation point in an offset open joint (Gardner & Sitar 2018, section 6.2), on three grids.

use super::{CaseContext, Outcome, Trial, record::describe, tank::Tank};
use anyhow::Context;
use riprap::scene::{Field, ProbePlace, Scene};
use std::path::Path;

/// The bundled scene, with cells of 1/16 in.
const SCENE: &str = include_str!("../../scenes/offset_joint.toml");
/// Cell size of the three grids over that of the scene: 4, 8 and 16 cells across the joint.
const GRIDS: [f64; 3] = [2.0, 1.0, 0.5];
/// The same on a CPU, where the finest of those grids would take most of an hour: 4, 6 and 8 cells across the joint.
const COARSE_GRIDS: [f64; 3] = [2.0, 4.0 / 3.0, 1.0];
/// Time at which the flow has developed and the means begin, s.
const BEGIN: f64 = 0.1;
/// Time between samples of the means, s.
const SAMPLE: f64 = 0.5e-3;
/// Pressure of the approaching flow, ρV²/2 with 20 ft/s of water, Pa.
const DYNAMIC: f64 = 0.5 * 1000.0 * 6.096 * 6.096;

/// Lower and upper corner, m.
type Region = ([f64; 3], [f64; 3]);

/// Means over time and span in the regions of the scene's probes.
struct Means {
    /// Height of the cells next to the downstream face, m, and the pressure there, Pa.
    face: Vec<(f64, f64)>,
    /// Pressure in the joint, Pa.
    joint: f64,
    /// Largest and smallest upward velocity in the joint, m/s.
    upright: [f64; 2],
    trial: Trial,
}

/// Position of the stagnation point, on three successively finer grids.
pub fn stagnation(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    let grids = if context.software {
        COARSE_GRIDS
    } else {
        GRIDS
    };
    let mut before: Option<[f64; 2]> = None;
    for ratio in grids {
        let mut scene = Scene::from_toml(SCENE, Path::new("."), "offset_joint.toml")?;
        scene.domain.cell *= ratio;
        let cell = scene.domain.cell;
        let means = measure(context, &scene)?;
        let trial = &means.trial;
        let (height, pressure) = peak(&means.face);
        let name = |what: &str| format!("{what}, cell {:.3} mm", 1e3 * cell);
        records.push(trial.report(name("stagnation point, m"), height));
        records.push(trial.report(name("its pressure / (ρV²/2)"), pressure / DYNAMIC));
        let joint = means.joint / DYNAMIC;
        records.push(trial.at_most(name("joint's pressure / (ρV²/2)"), joint, 1.0));
        // Water that circulates in the joint moves up and down; none can pass through.
        let [up, down] = means.upright.map(|v| v / 6.096);
        records.push(trial.report(name("largest mean upward velocity in the joint / V"), up));
        records.push(trial.report(name("largest mean downward velocity there / V"), -down));
        if let Some([before, coarse]) = before.replace([height, cell]) {
            let change = (height - before).abs() / coarse;
            records.push(trial.at_most(name("its change / coarse cell"), change, 1.0));
        }
    }
    Ok(records)
}

/// Runs the scene; the means begin when the flow has developed.
fn measure(context: &CaseContext, scene: &Scene) -> anyhow::Result<Means> {
    let mut tank = Tank::fill(context, scene)?;
    let end = scene.run.duration.context("the scene has a duration")?;
    let cell = scene.domain.cell;
    let [mut face, joint] = [region(scene, "downstream_face")?, region(scene, "joint")?];
    // Only the cells that touch the face.
    face.0[0] = face.1[0] - cell;
    let centres: Vec<_> = scene.domain.centres().collect();
    let open = |n: &u32| tank.simulation.solid().get(*n as usize) != Some(&true);
    let seen = |n: &u32| {
        [face, joint]
            .iter()
            .any(|r| within(r, &centres[*n as usize]))
    };
    let all = 0..centres.len() as u32;
    let cells: Vec<u32> = all.filter(open).filter(seen).collect();
    let mut pressure = vec![0.0; cells.len()];
    let mut upright = vec![0.0; cells.len()];
    let steps = |time: f64| (time / tank.simulation.time_step()).round().max(1.0) as u64;
    let (begin, sample) = (steps(BEGIN), steps(SAMPLE));
    tank.advance(begin)?;
    let mut samples = 0.0;
    while tank.simulation.time() < end {
        tank.advance(sample)?;
        let arrays = tank.read(&[Field::Pressure, Field::Velocity], &cells)?;
        for n in 0..cells.len() {
            pressure[n] += f64::from(arrays[0].values[n]);
            upright[n] += f64::from(arrays[1].values[3 * n + 1]);
        }
        samples += 1.0;
    }
    let layers = f64::from(scene.cells()[2]);
    let at = |n: &usize| &centres[cells[*n] as usize];
    let mut rows: Vec<(f64, f64)> = Vec::new();
    for n in (0..cells.len()).filter(|n| within(&face, at(n))) {
        let (y, p) = (at(&n)[1], pressure[n] / samples / layers);
        match rows.iter_mut().find(|row| (row.0 - y).abs() < 0.1 * cell) {
            Some(row) => row.1 += p,
            None => rows.push((y, p)),
        }
    }
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let in_joint: Vec<_> = (0..cells.len()).filter(|n| within(&joint, at(n))).collect();
    let speeds = || in_joint.iter().map(|&n| upright[n] / samples);
    let sum: f64 = in_joint.iter().map(|&n| pressure[n] / samples).sum();
    Ok(Means {
        face: rows,
        joint: sum / in_joint.len() as f64,
        upright: [
            speeds().fold(f64::NEG_INFINITY, f64::max),
            speeds().fold(f64::INFINITY, f64::min),
        ],
        trial: Trial {
            setup: describe(tank.lattice().setup()),
            ..tank.trial("")
        },
    })
}

/// Lower and upper corner of a probe of the scene, m.
fn region(scene: &Scene, name: &str) -> anyhow::Result<Region> {
    let probe = scene.probes.iter().find(|probe| probe.name == name);
    match probe.map(|probe| &probe.place) {
        Some(&ProbePlace::Box { min, max } | &ProbePlace::Face { min, max, .. }) => Ok((min, max)),
        _ => anyhow::bail!("the scene has no box or face called `{name}`"),
    }
}

/// Whether a point is in a region, seen in the plane of the flow.
fn within(region: &Region, point: &[f64; 3]) -> bool {
    (0..2).all(|a| point[a] > region.0[a] && point[a] < region.1[a])
}

/// Height and value of the maximum, from the parabola through the largest value and its neighbours.
fn peak(values: &[(f64, f64)]) -> (f64, f64) {
    let largest = (0..values.len()).max_by(|&a, &b| values[a].1.total_cmp(&values[b].1));
    let Some(n) = largest else {
        return (f64::NAN, f64::NAN);
    };
    let (height, p) = values[n];
    if n == 0 || n + 1 == values.len() {
        return (height, p);
    }
    let (below, above) = (values[n - 1].1, values[n + 1].1);
    let shift = 0.5 * (below - above) / (below - 2.0 * p + above);
    let spacing = values[n].0 - values[n - 1].0;
    (height + shift * spacing, p - 0.25 * (below - above) * shift)
}
