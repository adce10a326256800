//! Statistics over time.

use schemars::JsonSchema;
use serde::Deserialize;

use super::rules::{interval, not_negative, refuse};
use super::{Field, Probe, Scene};
use crate::error::Result;

/// Means and fluctuations over time, from the time at which the flow has developed.
///
/// Each probe with `every` then also writes `NAME_statistics.csv`, with mean, RMS, skewness, extremes and the statistical error
/// of the mean of each of its columns. A probe with one row also writes a spectrum, `NAME_spectrum.csv`, and a line the
/// correlation between its points, `NAME_correlation.csv`. A fluid on a lattice also has the fields `mean_velocity`,
/// `mean_pressure`, `pressure_rms`, `reynolds_stress` and `turbulent_kinetic_energy`, wherever fields are named.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Statistics {
    /// Time from which samples are taken, s.
    pub from: f64,
    /// Time between samples of the fields, s, rounded to an odd number of steps: velocities next to walls may alternate from one
    /// step to the next. Default 21 steps.
    #[serde(default)]
    pub every: Option<f64>,
}

impl Statistics {
    /// Default number of steps between samples of the fields.
    pub const STRIDE: u64 = 21;

    /// Steps of `time_step` (s) between samples of the fields, an odd number.
    pub fn stride(&self, time_step: f64) -> u64 {
        let nearest_odd = |every: f64| 2 * (every / time_step / 2.0).floor() as u64 + 1;
        self.every.map_or(Self::STRIDE, nearest_odd)
    }

    /// The first step, of `time_step` (s), with samples.
    pub fn first_step(&self, time_step: f64) -> u64 {
        (self.from / time_step).round() as u64
    }
}

impl Scene {
    pub(super) fn check_statistics(&self) -> Result<()> {
        let Some(statistics) = &self.statistics else {
            return Ok(());
        };
        not_negative("statistics.from", statistics.from, "s")?;
        interval("statistics.every", statistics.every)?;
        match self.run.duration {
            Some(end) if statistics.from >= end => refuse(
                "statistics.from",
                format!(
                    "is {} s and the run ends at {end} s: nothing would be sampled; begin earlier, or run longer",
                    statistics.from
                ),
            ),
            _ => Ok(()),
        }
    }

    /// Checks that fields that are time statistics are requested only with the table `statistics`.
    pub(super) fn check_statistical(&self, key: &str, fields: &[Field]) -> Result<()> {
        match fields.iter().find(|field| field.is_statistical()) {
            Some(field) if self.statistics.is_none() => refuse(
                key,
                format!(
                    "`{}` is a time statistic; add [statistics] with `from`, the time (s) of the first sample, or leave it out",
                    field.name()
                ),
            ),
            _ => Ok(()),
        }
    }

    /// Whether some output shows statistics of fields.
    pub fn shows_statistics(&self) -> bool {
        let slices = self.output.slices.iter().map(|slice| slice.field);
        let of_views = self.views.iter().flat_map(|view| &view.slices);
        let mut slices = slices.chain(of_views.map(|slice| slice.field));
        let of_probes = self.probes.iter().flat_map(|probe: &Probe| &probe.fields);
        let mut fields = self.output.fields.iter().chain(of_probes);
        fields.any(|field| field.is_statistical())
            || slices.any(|slice| slice.field().is_statistical())
    }
}
