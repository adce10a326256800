//! Stops a run when the statistical errors of means are small enough.

use super::{TableStatistics, groups};
use anyhow::{Result, bail};
use riprap::Error;
use serde::Serialize;
use std::{fmt, str::FromStr};

/// The relative statistical error of the mean of each quantity of a table: the largest over its places, relative to the
/// largest root mean square; `None` if there are too few samples.
pub fn relative_errors(table: &TableStatistics) -> Vec<Option<f64>> {
    let mut first = 0;
    let of_group = |(_, members): (String, Vec<String>)| {
        let columns = first..first + members.len();
        first = columns.end;
        let (mut scale, mut error) = (0.0_f64, Some(0.0_f64));
        for station in &table.stations {
            let series = || {
                station.series[columns.clone()]
                    .iter()
                    .filter(|s| s.count() > 0)
            };
            let square = series()
                .map(|s| s.mean().powi(2) + s.variance())
                .sum::<f64>();
            scale = scale.max(square.sqrt());
            let squares: Option<f64> = series().map(|s| s.error().map(|e| e * e)).sum();
            error = error.zip(squares).map(|(most, own)| most.max(own.sqrt()));
        }
        error.map(|error| if error > 0.0 { error / scale } else { 0.0 })
    };
    groups(&table.columns).into_iter().map(of_group).collect()
}

/// The error at which a run may stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UntilError(pub f64);

impl FromStr for UntilError {
    type Err = String;

    /// Parses `2%` or `0.02`.
    fn from_str(text: &str) -> Result<Self, String> {
        let (number, scale) = match text.trim().strip_suffix('%') {
            Some(number) => (number, 0.01),
            None => (text, 1.0),
        };
        match number.trim().parse::<f64>() {
            Ok(value) if value > 0.0 && value * scale < 1.0 => Ok(Self(value * scale)),
            _ => Err(format!(
                "`{text}` is no error; give a part such as 2% or 0.02, above 0 and below 1"
            )),
        }
    }
}

/// Criterion by which a run stops.
#[derive(Clone, Debug)]
pub struct Convergence {
    /// Relative error at which it stops.
    until: f64,
    /// Tables, or quantities of tables as `table.quantity`, that are considered.
    of: Vec<String>,
}

/// Largest statistical error, for the summary.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Converged {
    /// Relative error at which the run stops.
    pub until: f64,
    /// The largest error at the end of the run; `None` if there are too few samples.
    pub error: Option<f64>,
    /// Its quantity, `table.quantity`.
    pub of: String,
    /// Whether all errors are small enough.
    pub reached: bool,
}

impl Convergence {
    /// Stops at the error `until` of the tables and quantities `of`, or of all `probes` if none are named, in a run with these
    /// tables.
    pub fn new(
        until: UntilError,
        of: &[String],
        probes: &[&str],
        tables: &[&TableStatistics],
    ) -> Result<Self> {
        let is_of_probe = |name: &str| {
            let probe = name.strip_suffix("_faces").unwrap_or(name);
            probes.contains(&name) || probes.contains(&probe)
        };
        let mut names = Vec::new();
        for table in tables {
            names.push(table.name());
            let stems = groups(&table.columns).into_iter().map(|(stem, _)| stem);
            names.extend(stems.map(|stem| format!("{}.{stem}", table.name())));
        }
        let of_probes: Vec<String> = tables
            .iter()
            .map(|table| table.name())
            .filter(|name| is_of_probe(name))
            .collect();
        if of.is_empty() && of_probes.is_empty() {
            let message = "no probe of this scene has statistics; add [statistics] with `from`, and a probe with `every`";
            bail!(Error::argument("--until-error", message));
        }
        if let Some(unknown) = of.iter().find(|requested| !names.contains(requested)) {
            let message = format!(
                "there are no statistics of `{unknown}`; there are those of {}",
                names.join(", ")
            );
            bail!(Error::argument("--error-of", message));
        }
        Ok(Self {
            until: until.0,
            of: if of.is_empty() {
                of_probes
            } else {
                of.to_vec()
            },
        })
    }

    /// The present largest error of the means of `tables`.
    pub fn now(&self, tables: &[&TableStatistics]) -> Converged {
        let mut errors = Vec::new();
        for table in tables {
            let own = table.name();
            let names = groups(&table.columns).into_iter();
            let names = names.map(|(stem, _)| format!("{own}.{stem}"));
            let counts = |name: &String| self.of.contains(&own) || self.of.contains(name);
            let named: Vec<_> = names.enumerate().filter(|(_, name)| counts(name)).collect();
            if named.is_empty() {
                continue;
            }
            let known = table.errors();
            let error = |number: usize| known.as_ref().and_then(|known| known[number]);
            errors.extend(
                named
                    .into_iter()
                    .map(|(number, name)| (name, error(number))),
            );
        }
        // An unknown error is the worst.
        let size = |(_, error): &&(String, Option<f64>)| error.unwrap_or(f64::INFINITY);
        let worst = errors.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
        let (of, error) = worst.cloned().unwrap_or_default();
        Converged {
            until: self.until,
            reached: error.is_some_and(|error| error <= self.until),
            error,
            of,
        }
    }
}

impl fmt::Display for Converged {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let until = 100.0 * self.until;
        match self.error {
            Some(error) if self.reached => write!(
                f,
                "  statistical error of means: {:.2} % at most ({}), below {until} %",
                100.0 * error,
                self.of
            ),
            Some(error) => write!(
                f,
                "  statistical error of means: {:.2} % at most ({}); {until} % would take about {:.1} times as many samples",
                100.0 * error,
                self.of,
                (error / self.until).powi(2)
            ),
            None => write!(
                f,
                "  statistical error of means: that of {} is not known yet, too few samples; run longer, or let its probe measure more often",
                self.of
            ),
        }
    }
}
