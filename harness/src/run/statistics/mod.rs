//! Statistics of the rows of a table over time: `NAME_statistics.csv`, for single rows `NAME_spectrum.csv`, for lines
//! `NAME_correlation.csv`, each with its picture.

mod correlation;
mod spectrum;
mod until;

pub use until::{Converged, Convergence, UntilError};

use super::{estimate::unit, recorder::RunLog};
use crate::picture::{Chart, Measure, Track};
use anyhow::Result;
use correlation::Correlation;
use riprap::output::{Csv, Series, Table};
use spectrum::spectra;
use std::path::{Path, PathBuf};
use until::relative_errors;

/// Statistics of one column.
const STATISTICS: [&str; 7] = [
    "mean",
    "error",
    "rms",
    "skewness",
    "min",
    "max",
    "integral_time",
];
/// Fewest samples from which errors may end a run: batches of at least four.
const SAMPLES: u64 = 256;
/// Products of the fluctuations of the components of a velocity.
const PRODUCTS: [(&str, [usize; 2]); 3] = [("xy", [0, 1]), ("yz", [1, 2]), ("xz", [0, 2])];

/// Statistics of a table: for each of its columns, at each place that it has rows for.
pub struct TableStatistics {
    path: PathBuf,
    title: String,
    /// s
    from: f64,
    /// Leading columns with the place of a row.
    coordinates: Vec<String>,
    columns: Vec<String>,
    /// Index of the first column of a velocity, if there is one.
    velocity: Option<usize>,
    stations: Vec<Station>,
    /// First and last time of the samples, s.
    times: Option<[f64; 2]>,
    count: u64,
    /// All samples of the columns, if the table has a single row per time; for spectra.
    single: Option<Vec<Vec<f64>>>,
    correlation: Option<Correlation>,
}

/// Statistics at one place.
#[derive(Default)]
struct Station {
    coordinates: Vec<f64>,
    series: Vec<Series>,
    /// Sums of products of fluctuations of the velocity.
    products: [f64; 3],
}

impl Station {
    fn push(&mut self, row: &[f64], coordinates: usize, velocity: Option<usize>) {
        let values = &row[coordinates..];
        self.coordinates = row[..coordinates].to_vec();
        self.series.resize_with(values.len(), Series::default);
        let deviation = |series: &[Series], at: usize| values[at] - series[at].mean();
        let before =
            velocity.map(|first| [0, 1, 2].map(|axis| deviation(&self.series, first + axis)));
        for (series, value) in self.series.iter_mut().zip(values) {
            series.push(*value);
        }
        let Some((first, before)) = velocity.zip(before) else {
            return;
        };
        for ((_, [a, b]), sum) in PRODUCTS.into_iter().zip(&mut self.products) {
            // NaN before the first sample, which has no mean to deviate from.
            let product = before[a] * deviation(&self.series, first + b);
            if product.is_finite() {
                *sum += product;
            }
        }
    }
}

impl TableStatistics {
    /// Statistics of the table at `path` from the time `from` (s) on; `columns` are those after step and time, the first few of
    /// which are `coordinates`.
    pub fn new(
        path: &Path,
        title: &str,
        from: f64,
        columns: &[String],
        coordinates: usize,
    ) -> Self {
        let (coordinates, columns) = columns.split_at(coordinates);
        let (coordinates, columns) = (coordinates.to_vec(), columns.to_vec());
        let velocity = columns.iter().position(|name| name == "velocity_x");
        Self {
            path: path.to_owned(),
            title: title.to_owned(),
            from,
            coordinates,
            velocity: velocity.filter(|first| {
                columns
                    .get(first + 2)
                    .is_some_and(|name| name == "velocity_z")
            }),
            columns,
            stations: Vec::new(),
            times: None,
            count: 0,
            single: None,
            correlation: None,
        }
    }

    /// Adds the rows that the table already holds, after a restart.
    pub fn replay(&mut self) -> riprap::Result<()> {
        let table = Table::read(&self.path)?;
        let [(_, steps), (_, times), columns @ ..] = &table.columns[..] else {
            return Ok(());
        };
        let mut first = 0;
        while first < steps.len() {
            let same = steps[first..]
                .iter()
                .take_while(|step| **step == steps[first]);
            let last = first + same.count();
            let row = |n: usize| columns.iter().map(|(_, values)| values[n]).collect();
            let rows: Vec<Vec<f64>> = (first..last).map(row).collect();
            self.push(times[first], &rows);
            first = last;
        }
        Ok(())
    }

    /// Adds the rows of a time (s).
    pub fn push(&mut self, time: f64, rows: &[Vec<f64>]) {
        // Times are multiples of the step: one that equals `from` up to rounding counts.
        if time < self.from * (1.0 - 1e-12) || rows.is_empty() {
            return;
        }
        if self.count == 0 {
            self.single = (rows.len() == 1).then(|| vec![Vec::new(); self.columns.len()]);
            self.correlation = Correlation::new(rows, self.coordinates.len());
        }
        self.count += 1;
        let [first, _] = *self.times.get_or_insert([time; 2]);
        self.times = Some([first, time]);
        if self.stations.len() < rows.len() {
            self.stations.resize_with(rows.len(), Station::default);
        }
        for (station, row) in self.stations.iter_mut().zip(rows) {
            station.push(row, self.coordinates.len(), self.velocity);
        }
        if let Some(columns) = &mut self.single {
            let values = columns.iter_mut().zip(&rows[0][self.coordinates.len()..]);
            values.for_each(|(column, value)| column.push(*value));
        }
        if let Some(correlation) = &mut self.correlation {
            correlation.push(rows);
        }
    }

    /// The relative errors of the means of its quantities. `None` while there are too few samples, or while they span less time
    /// than `from`, the time given to the flow to develop: errors do not include slower motions before.
    fn errors(&self) -> Option<Vec<Option<f64>>> {
        let length = self.times.map_or(0.0, |[first, last]| last - first);
        let enough = self.count >= SAMPLES && length >= self.from;
        enough.then(|| relative_errors(self))
    }

    fn name(&self) -> String {
        let stem = self.path.file_stem().unwrap_or_default();
        stem.to_string_lossy().into()
    }

    /// Mean time between samples, s.
    fn interval(&self) -> f64 {
        let length = self.times.map_or(0.0, |[first, last]| last - first);
        length / self.count.saturating_sub(1).max(1) as f64
    }

    /// Writes all statistics at the end of a run, at `step` and `time` (s).
    pub fn write(&self, log: &mut RunLog, step: u64, time: f64) -> Result<()> {
        if self.count == 0 {
            log.warnings.push(format!(
                "{}: nothing was sampled from statistics.from = {} s on; run longer, or begin earlier",
                self.name(),
                self.from
            ));
            return Ok(());
        }
        self.write_moments(log, (step, time))?;
        if let Some(columns) = &self.single {
            let rows = spectra(columns, self.interval());
            self.write_curves(log, (step, time), Curves::Spectrum, &rows)?;
        }
        if let Some(correlation) = &self.correlation {
            let rows = correlation.rows();
            self.write_curves(log, (step, time), Curves::Correlation, &rows)?;
        }
        Ok(())
    }

    fn write_moments(&self, log: &mut RunLog, (step, time): (u64, f64)) -> Result<()> {
        let mut columns = self.coordinates.clone();
        columns.push("samples".into());
        let with = |column: &String| STATISTICS.map(|what| format!("{column}_{what}"));
        columns.extend(self.columns.iter().flat_map(with));
        if self.velocity.is_some() {
            columns.extend(PRODUCTS.map(|(axes, _)| format!("velocity_covariance_{axes}")));
        }
        let path = self.beside("statistics", "csv");
        let mut table = Csv::create(&path, &columns)?;
        for station in &self.stations {
            let mut row = station.coordinates.clone();
            row.push(self.count as f64);
            for series in &station.series {
                let [min, max] = series.range();
                let integral = series
                    .integral_time()
                    .map(|samples| samples * self.interval());
                row.extend([
                    series.mean(),
                    series.error().unwrap_or(f64::NAN),
                    series.rms(),
                    series.skewness(),
                    min,
                    max,
                    integral.unwrap_or(f64::NAN),
                ]);
            }
            if self.velocity.is_some() {
                row.extend(station.products.map(|sum| sum / self.count as f64));
            }
            table.append(step, time, &row)?;
        }
        log.file(path.clone());
        if self.coordinates.first().is_some_and(|name| name == "s") && self.stations.len() > 1 {
            let picture = path.with_extension("png");
            log.picture(picture.clone(), self.draw_profiles(&path, &picture));
        }
        Ok(())
    }

    /// Draws means and RMS along a line.
    fn draw_profiles(&self, table: &Path, picture: &Path) -> Result<()> {
        let table = Table::read(table)?;
        let mut tracks = Vec::new();
        for what in ["mean", "rms"] {
            for (stem, columns) in groups(&self.columns) {
                let with = |column: &String| format!("{column}_{what}");
                let columns: Vec<String> = columns.iter().map(with).collect();
                let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
                tracks.push(Track::new(
                    &format!("{what} of {stem}"),
                    unit(&stem),
                    &columns,
                ));
            }
        }
        let chart = Chart::tracks(
            &self.title,
            &table,
            ("s", Measure::linear("s", "m")),
            &tracks,
        )?;
        chart.draw(picture)
    }

    /// Writes `rows`, a curve per column over a common abscissa, and draws them.
    fn write_curves(
        &self,
        log: &mut RunLog,
        (step, time): (u64, f64),
        curves: Curves,
        rows: &[Vec<f64>],
    ) -> Result<()> {
        if rows.is_empty() {
            return Ok(());
        }
        let (name, shared) = curves.names();
        let mut columns = vec![shared.to_owned()];
        columns.extend(self.columns.iter().cloned());
        let path = self.beside(name, "csv");
        let mut table = Csv::create(&path, &columns)?;
        for row in rows {
            table.append(step, time, row)?;
        }
        log.file(path.clone());
        let shown = |name: &String| {
            let column = columns.iter().position(|column| column == name);
            column.is_some_and(|column| rows.iter().any(|row| curves.shows(row[column])))
        };
        let mut tracks = Vec::new();
        for (stem, columns) in groups(&self.columns) {
            let columns: Vec<&str> = columns
                .iter()
                .filter(|name| shown(name))
                .map(String::as_str)
                .collect();
            if !columns.is_empty() {
                tracks.push(curves.track(&stem, &columns));
            }
        }
        if !tracks.is_empty() {
            let picture = path.with_extension("png");
            let table = Table::read(&path)?;
            let chart = Chart::tracks(&self.title, &table, (shared, curves.measure()), &tracks);
            log.picture(
                picture.clone(),
                chart.and_then(|chart| chart.draw(&picture)),
            );
        }
        Ok(())
    }

    fn beside(&self, what: &str, extension: &str) -> PathBuf {
        self.path
            .with_file_name(format!("{}_{what}.{extension}", self.name()))
    }
}

/// Kinds of curves that accompany a table.
#[derive(Clone, Copy)]
enum Curves {
    Spectrum,
    Correlation,
}

impl Curves {
    /// Suffix of the name of their table, and the name of its first column.
    fn names(self) -> (&'static str, &'static str) {
        match self {
            Self::Spectrum => ("spectrum", "frequency"),
            Self::Correlation => ("correlation", "separation"),
        }
    }

    /// The horizontal axis.
    fn measure(self) -> Measure {
        let (_, name) = self.names();
        match self {
            Self::Spectrum => Measure::logarithmic(name, "Hz"),
            Self::Correlation => Measure::linear(name, "m"),
        }
    }

    /// Whether a value can be drawn.
    fn shows(self, value: f64) -> bool {
        match self {
            Self::Spectrum => value > 0.0,
            Self::Correlation => value.is_finite(),
        }
    }

    fn track(self, stem: &str, columns: &[&str]) -> Track {
        match self {
            Self::Spectrum => {
                let unit = match unit(stem) {
                    "" => String::new(),
                    unit => format!("({unit})²/Hz"),
                };
                Track::logarithmic(&format!("PSD of {stem}"), &unit, columns)
            }
            Self::Correlation => Track::new(&format!("correlation of {stem}"), "", columns),
        }
    }
}

/// Groups columns by quantity: the components of a vector together, each other column by itself.
fn groups(columns: &[String]) -> Vec<(String, Vec<String>)> {
    let mut groups: Vec<(String, Vec<String>)> = Vec::new();
    for column in columns {
        let stem = ["_x", "_y", "_z"]
            .iter()
            .find_map(|end| column.strip_suffix(end))
            .unwrap_or(column);
        match groups.last_mut() {
            Some((name, members)) if name == stem => members.push(column.clone()),
            _ => groups.push((stem.to_owned(), vec![column.clone()])),
        }
    }
    groups
}
