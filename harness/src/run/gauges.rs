//! A table per probe in free water: `NAME.csv`, with NaN if the probe is dry. Levels, positions and volumes are
//! plotted over time: `NAME.png`.

use super::{recorder::Recorder, scene_run::SceneRun, table::TimeTable};
use crate::picture::Track;
use anyhow::Result;
use glam::DVec3;
use riprap::{
    scene::{Field, Probe, ProbePlace},
    sph::{Interpolator, Setup, SphSolver, Water},
};
use std::path::Path;

/// The recorder of the table of `probe`.
pub fn recorder(
    run: &SceneRun,
    folder: &Path,
    last: u64,
    probe: &Probe,
) -> riprap::Result<Box<dyn Recorder>> {
    let scene = run.scene();
    let plane = scene.particles.as_ref().is_some_and(|p| p.plane);
    let table = TimeTable {
        name: probe.name.clone(),
        every: probe.every,
        columns: columns(probe),
        coordinates: Some(match probe.place {
            ProbePlace::Line { .. } => 4,
            _ => 0,
        }),
        tracks: tracks(&probe.place, plane),
        title: format!("{}: {}", scene.title, probe.name),
    };
    let probe = probe.clone();
    table.recorder(run, folder, last, move |run, _| rows(run, &probe))
}

fn columns(probe: &Probe) -> Vec<String> {
    let own: &[&str] = match &probe.place {
        ProbePlace::Gauge { .. } => &["level"],
        ProbePlace::Sensor { .. } => &["pressure", "impulse"],
        ProbePlace::RunUp { .. } => &["x", "y", "z"],
        ProbePlace::Line { .. } => &["s", "x", "y", "z"],
        ProbePlace::Box { .. } => &["volume"],
        _ => &[],
    };
    let mut columns: Vec<String> = own.iter().map(|name| (*name).into()).collect();
    let of_fields = probe.fields.iter().flat_map(|field| field.columns());
    match &probe.place {
        ProbePlace::Point { .. } | ProbePlace::Line { .. } => columns.extend(of_fields),
        ProbePlace::Box { .. } => columns.extend(
            of_fields.flat_map(|column| ["mean", "min", "max"].map(|of| format!("{column}_{of}"))),
        ),
        _ => {}
    }
    columns
}

/// Plotted quantities of a probe; fields are not plotted, nor is y of a planar scene, which is constant.
fn tracks(place: &ProbePlace, plane: bool) -> Vec<Track> {
    match place {
        ProbePlace::Gauge { .. } => vec![Track::new("level", "m", &["level"])],
        ProbePlace::Sensor { .. } => vec![Track::new("pressure", "Pa", &["pressure"])],
        ProbePlace::RunUp { .. } => {
            let axes: &[&str] = if plane { &["x", "z"] } else { &["x", "y", "z"] };
            let track = |axis: &&str| Track::new(&format!("farthest {axis}"), "m", &[axis]);
            axes.iter().map(track).collect()
        }
        ProbePlace::Box { .. } => vec![Track::new("volume", "m³", &["volume"])],
        _ => Vec::new(),
    }
}

fn rows(run: &mut SceneRun, probe: &Probe) -> Result<Vec<Vec<f64>>> {
    if let Some(reading) = run.simulation.sensor(&probe.name) {
        return Ok(vec![vec![reading.pressure, reading.impulse]]);
    }
    let water = run.water()?;
    let Some(setup) = run.simulation.particles().map(SphSolver::setup) else {
        return Ok(Vec::new());
    };
    let gauges = Interpolator::new(setup, &water.positions);
    let at = |place: [f64; 3]| at_point(&gauges, setup, &water, &probe.fields, place);
    Ok(match &probe.place {
        ProbePlace::Gauge { at } => vec![vec![gauges.level(*at).unwrap_or(f64::NAN)]],
        ProbePlace::RunUp {
            min,
            max,
            direction,
        } => {
            let along = DVec3::AXES[direction.axis().index()] * f64::from(direction.sign());
            let found = gauges.farthest((*min).into(), (*max).into(), along);
            vec![found.unwrap_or(DVec3::NAN).to_array().into()]
        }
        ProbePlace::Point { at: place } => vec![at(*place)],
        ProbePlace::Line { .. } => {
            let station =
                |(s, [x, y, z]): (f64, [f64; 3])| [vec![s, x, y, z], at([x, y, z])].concat();
            probe.place.stations().into_iter().map(station).collect()
        }
        ProbePlace::Box { min, max } => {
            let inside: Vec<usize> = gauges.inside((*min).into(), (*max).into()).collect();
            vec![in_box(&inside, setup, &water, &probe.fields)]
        }
        // Scenes with particles have no other probes.
        _ => Vec::new(),
    })
}

/// The components of a field of all particles, and their gradients in water at rest, per metre.
fn components(setup: &Setup, water: &Water, field: Field) -> Vec<(Vec<f64>, DVec3)> {
    match field {
        Field::Velocity => (0..3)
            .map(|axis| {
                let along = water.velocities.iter().map(|v| v[axis].into());
                (along.collect(), DVec3::ZERO)
            })
            .collect(),
        Field::Pressure => vec![(water.pressures.clone(), setup.density * setup.gravity)],
        _ => vec![(water.densities.clone(), DVec3::ZERO)],
    }
}

/// The components of fields at a point; NaN without water.
fn at_point(
    gauges: &Interpolator<'_>,
    setup: &Setup,
    water: &Water,
    fields: &[Field],
    at: [f64; 3],
) -> Vec<f64> {
    let all = fields
        .iter()
        .flat_map(|field| components(setup, water, *field));
    let mean = |(values, gradient): (Vec<f64>, DVec3)| gauges.mean(at.into(), &values, gradient);
    all.map(|field| mean(field).unwrap_or(f64::NAN)).collect()
}

/// The volume of the particles with the given indices, and mean, minimum and maximum of each component of the fields.
fn in_box(inside: &[usize], setup: &Setup, water: &Water, fields: &[Field]) -> Vec<f64> {
    let count = inside.len() as f64;
    let mut row = vec![count * setup.particle_mass() / setup.density];
    for (values, _) in fields
        .iter()
        .flat_map(|field| components(setup, water, *field))
    {
        let values = || inside.iter().map(|n| values[*n]);
        row.extend([
            values().sum::<f64>() / count,
            values().fold(f64::NAN, f64::min),
            values().fold(f64::NAN, f64::max),
        ]);
    }
    row
}
