//! A table for each probe in the water: `NAME.csv`. Where a probe is dry it has no number. Levels, places and volumes are
//! drawn over time: `NAME.png`.

use super::super::{
    curves,
    engine::Engine,
    history::table,
    recorder::{Notes, Recorder},
    schedule::Schedule,
};
use super::Pond;
use crate::picture::Track;
use anyhow::Result;
use glam::DVec3;
use riprap::{
    output::Csv,
    particles::{Gauges, Setup, Water},
    scene::{Field, Probe, ProbePlace},
};
use std::path::{Path, PathBuf};

pub struct GaugeTable {
    schedule: Schedule,
    probe: Probe,
    path: PathBuf,
    table: Csv,
}

impl GaugeTable {
    /// Begins the table, or goes on with it after a restart.
    pub fn new(engine: &Pond, folder: &Path, last: u64, probe: &Probe) -> Result<Self> {
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
            schedule: Schedule::of(probe.every, engine.time_step(), last),
            table: table(engine, &path, &columns)?,
            probe: probe.clone(),
            path,
        })
    }
}

impl Recorder<Pond> for GaugeTable {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, engine: &mut Pond, notes: &mut Notes) -> Result<()> {
        if let Some(felt) = engine.simulation.sensor(&self.probe.name) {
            let row = [felt.pressure, felt.impulse];
            self.table.append(engine.step(), engine.time(), &row)?;
            notes.file(self.path.clone());
            return Ok(());
        }
        let water = engine.water()?;
        let setup = engine.simulation.particles().setup();
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
            // A scene of particles has no others.
            _ => Vec::new(),
        };
        for row in rows {
            self.table.append(engine.step(), engine.time(), &row)?;
        }
        notes.file(self.path.clone());
        Ok(())
    }

    fn finish(&mut self, engine: &Pond, notes: &mut Notes) -> Result<()> {
        let scene = engine.scene();
        let title = format!("{}: {}", scene.title, self.probe.name);
        let mut tracks = drawn(&self.probe.place);
        if scene
            .particles
            .as_ref()
            .is_some_and(|particles| particles.plane)
        {
            // Nothing happens along it.
            tracks.retain(|track| *track.columns != ["y"]);
        }
        curves::draw(scene, &self.path, &title, &tracks, notes)
    }
}

/// What is drawn of a probe at such a place; nothing of fields.
fn drawn(place: &ProbePlace) -> Vec<Track<'static>> {
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

/// The components of a field of all particles, and what they grow by a metre in water at rest.
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

/// The components of fields at a point.
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

/// The volume of these particles, and of each component of fields the mean, the least and the largest value.
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
