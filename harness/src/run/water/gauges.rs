//! A table for each probe in the water: `NAME.csv`. Where a probe is dry it has no number.

use super::super::{
    engine::Engine,
    history::table,
    recorder::{Notes, Recorder},
    schedule::Schedule,
};
use super::Pond;
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
        let columns: Vec<String> = match &probe.place {
            ProbePlace::Gauge { .. } => vec!["level".into()],
            ProbePlace::RunUp { .. } => ["x", "y", "z"].map(Into::into).into(),
            _ => probe.fields.iter().flat_map(|f| f.columns()).collect(),
        };
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
        let water = engine.water()?;
        let setup = engine.simulation.particles().setup();
        let gauges = Gauges::new(setup, &water.positions);
        let row = match &self.probe.place {
            ProbePlace::Gauge { at } => vec![gauges.level(*at).unwrap_or(f64::NAN)],
            ProbePlace::RunUp {
                min,
                max,
                direction,
            } => {
                let along = DVec3::AXES[direction.axis().index()] * f64::from(direction.sign());
                let found = gauges.farthest((*min).into(), (*max).into(), along);
                found.unwrap_or(DVec3::NAN).to_array().into()
            }
            ProbePlace::Point { at } => {
                let fields = self.probe.fields.iter();
                fields
                    .flat_map(|field| at_point(&gauges, setup, &water, *field, (*at).into()))
                    .collect()
            }
            // A scene of particles has no others.
            _ => Vec::new(),
        };
        self.table.append(engine.step(), engine.time(), &row)?;
        notes.file(self.path.clone());
        Ok(())
    }
}

/// The components of a field at a point.
fn at_point(
    gauges: &Gauges<'_>,
    setup: &Setup,
    water: &Water,
    field: Field,
    at: DVec3,
) -> Vec<f64> {
    let mean = |values: &[f64], gradient| gauges.mean(at, values, gradient).unwrap_or(f64::NAN);
    match field {
        Field::Velocity => (0..3)
            .map(|axis| {
                let along: Vec<f64> = water.velocities.iter().map(|v| v[axis].into()).collect();
                mean(&along, DVec3::ZERO)
            })
            .collect(),
        Field::Pressure => vec![mean(&water.pressures, setup.density * setup.gravity)],
        _ => vec![mean(&water.densities, DVec3::ZERO)],
    }
}
