//! A table for each probe in the water: `NAME.csv`, with NaN where the probe is dry. Levels, positions and volumes are
//! plotted over time: `NAME.png`.

use super::super::{
    curves,
    history::table,
    recorder::{Recorder, RunLog},
    scene_run::SceneRun,
    schedule::Schedule,
};
use crate::picture::Track;
use anyhow::Result;
use glam::DVec3;
use riprap::{
    output::Csv,
    scene::{Field, Probe, ProbePlace},
    sph::{Gauges, Setup, SphSolver, Water},
};
use std::path::{Path, PathBuf};

pub struct GaugeTable {
    schedule: Schedule,
    probe: Probe,
    path: PathBuf,
    table: Csv,
}

impl GaugeTable {
    /// Begins the table, or resumes it after a restart.
    pub fn new(run: &SceneRun, folder: &Path, last: u64, probe: &Probe) -> Result<Self> {
        let path = folder.join(format!("{}.csv", probe.name));
        let mut columns: Vec<String> = match &probe.place {
            ProbePlace::Gauge { .. } => vec!["level".into()],
            ProbePlace::Sensor { .. } => ["pressure", "impulse"].map(Into::into).into(),
            ProbePlace::RunUp { .. } => ["x", "y", "z"].map(Into::into).into(),
            ProbePlace::Line { .. } => ["s", "x", "y", "z"].map(Into::into).into(),
            ProbePlace::Box { .. } => vec!["volume".into()],
            _ => Vec::new(),
        };
        let of_fields = probe.fields.iter().flat_map(|field| field.columns());
        match &probe.place {
            ProbePlace::Point { .. } | ProbePlace::Line { .. } => columns.extend(of_fields),
            ProbePlace::Box { .. } => {
                columns.extend(of_fields.flat_map(|column| {
                    ["mean", "min", "max"].map(|what| format!("{column}_{what}"))
                }))
            }
            _ => {}
        }
        Ok(Self {
            schedule: Schedule::new(probe.every, run.time_step(), last),
            table: table(run, &path, &columns)?,
            probe: probe.clone(),
            path,
        })
    }
}

impl Recorder for GaugeTable {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, run: &mut SceneRun, log: &mut RunLog) -> Result<()> {
        if let Some(reading) = run.simulation.sensor(&self.probe.name) {
            let row = [reading.pressure, reading.impulse];
            self.table.append(run.step(), run.time(), &row)?;
            log.file(self.path.clone());
            return Ok(());
        }
        let water = run.water()?;
        let Some(setup) = run.simulation.particles().map(SphSolver::setup) else {
            return Ok(());
        };
        let gauges = Gauges::new(setup, &water.positions);
        let at = |place: [f64; 3]| at_point(&gauges, setup, &water, &self.probe.fields, place);
        let rows = match &self.probe.place {
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
                let stations = self.probe.place.stations();
                stations.into_iter().map(station).collect()
            }
            ProbePlace::Box { min, max } => {
                let inside: Vec<usize> = gauges.inside((*min).into(), (*max).into()).collect();
                vec![in_box(&inside, setup, &water, &self.probe.fields)]
            }
            // Scenes with particles have no other probes.
            _ => Vec::new(),
        };
        for row in rows {
            self.table.append(run.step(), run.time(), &row)?;
        }
        log.file(self.path.clone());
        Ok(())
    }

    fn finish(&mut self, run: &SceneRun, log: &mut RunLog) -> Result<()> {
        let scene = run.scene();
        let title = format!("{}: {}", scene.title, self.probe.name);
        let mut tracks = plotted_tracks(&self.probe.place);
        if scene
            .particles
            .as_ref()
            .is_some_and(|particles| particles.plane)
        {
            // y is constant in a planar scene.
            tracks.retain(|track| *track.columns != ["y"]);
        }
        curves::draw(scene, &self.path, &title, &tracks, log)
    }
}

/// Plotted quantities of a probe; fields are not plotted.
fn plotted_tracks(place: &ProbePlace) -> Vec<Track<'static>> {
    match place {
        ProbePlace::Gauge { .. } => vec![track("level", "m", &["level"])],
        ProbePlace::Sensor { .. } => vec![track("pressure", "Pa", &["pressure"])],
        ProbePlace::RunUp { .. } => vec![
            track("farthest x", "m", &["x"]),
            track("farthest y", "m", &["y"]),
            track("farthest z", "m", &["z"]),
        ],
        ProbePlace::Box { .. } => vec![track("volume", "m³", &["volume"])],
        _ => Vec::new(),
    }
}

fn track(
    quantity: &'static str,
    unit: &'static str,
    columns: &'static [&'static str],
) -> Track<'static> {
    Track {
        quantity,
        unit,
        columns,
    }
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
    gauges: &Gauges<'_>,
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
