//! A point of a diagram in numbers, and the table of them: `report.csv`.

use super::class::{Found, Point};
use riprap::{Error, output::replace};
use serde::Serialize;
use std::{
    fs::OpenOptions,
    io::Write,
    path::{Path, PathBuf},
};

/// Result and cost of a setting on a grid.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Row {
    /// Class of scenes.
    pub class: String,
    /// Setting.
    pub setting: String,
    /// Whether all settings are the defaults of the library.
    pub default: bool,
    /// Resolution of the grid, in the measure of the class.
    pub resolution: f64,
    /// Relaxation time, for a lattice.
    pub tau: Option<f64>,
    /// Largest y⁺ half a cell from a block at the end.
    pub y_plus: Option<f64>,
    /// Value found.
    pub value: Option<f64>,
    /// Expected value; `None` if the value is an error itself.
    pub reference: Option<f64>,
    /// Relative error of the value.
    pub error: Option<f64>,
    /// Relative uncertainty of the reference.
    pub uncertainty: f64,
    /// Cells of the domain, or particles of water.
    pub cells: u64,
    /// Steps; for particles, acoustic steps.
    pub steps: u64,
    /// Cells times steps.
    pub updates: u64,
    /// CPU time of the steps, all threads together, s.
    pub cpu_seconds: f64,
    /// Wall time of the steps, s.
    pub wall_seconds: f64,
    /// Why there is no number, if there is none.
    pub note: String,
}

/// A cost of a row.
pub type Cost = fn(&Row) -> f64;

/// Column heads.
pub const HEAD: &str = "class,setting,default,resolution,tau,y_plus,value,reference,error,uncertainty,cells,steps,\
    updates,cpu_seconds,wall_seconds,note";

impl Row {
    /// Whether the row belongs to a point of its class.
    pub fn is_of(&self, point: &Point) -> bool {
        // Decimals round-trip to the same number.
        self.setting == point.setting && self.resolution == point.resolution
    }

    /// Stores the result of a run, or the reason for which it has none.
    pub fn take(&mut self, found: anyhow::Result<Found>) {
        match found {
            Ok(found) => {
                let trial = found.trial;
                self.value = Some(found.value).filter(|value| value.is_finite());
                (self.tau, self.y_plus) = (found.tau, found.y_plus);
                (self.cells, self.steps) = (trial.cells, trial.steps);
                self.updates = trial.cells * trial.steps;
                self.cpu_seconds = trial.stepping.cpu;
                self.wall_seconds = trial.stepping.wall;
                if self.value.is_none() {
                    self.note = "what it found is not a number".into();
                }
            }
            // One field of the table: without separators.
            Err(error) => self.note = format!("{error:#}").replace([',', '\n'], ";"),
        }
    }

    /// Compares with the reference, whose relative uncertainty is `uncertainty`; without one the value is the error.
    pub fn compare(&mut self, reference: Option<f64>, uncertainty: f64) {
        (self.reference, self.uncertainty) = (reference, uncertainty);
        self.error = self.value.map(|value| match reference {
            Some(reference) => (value / reference - 1.0).abs(),
            None => value.abs(),
        });
    }

    /// Error, at least the uncertainty of the reference.
    pub fn certain_error(&self) -> Option<f64> {
        self.error.map(|error| error.max(self.uncertainty))
    }

    /// The row as a line of the table.
    pub fn line(&self) -> String {
        let or_none = |value: Option<f64>| value.map_or(String::new(), |v| v.to_string());
        [
            self.class.clone(),
            self.setting.clone(),
            u8::from(self.default).to_string(),
            self.resolution.to_string(),
            or_none(self.tau),
            or_none(self.y_plus),
            or_none(self.value),
            or_none(self.reference),
            or_none(self.error),
            self.uncertainty.to_string(),
            self.cells.to_string(),
            self.steps.to_string(),
            self.updates.to_string(),
            self.cpu_seconds.to_string(),
            self.wall_seconds.to_string(),
            self.note.clone(),
        ]
        .join(",")
    }

    /// Parses a line of the table; `None` if it is not a row.
    pub fn parse(line: &str) -> Option<Self> {
        let fields: Vec<&str> = line.split(',').collect();
        if fields.len() != HEAD.split(',').count() {
            return None;
        }
        let maybe = |n: usize| match fields[n] {
            "" => Some(None),
            text => text.parse().ok().map(Some),
        };
        Some(Self {
            class: fields[0].into(),
            setting: fields[1].into(),
            default: match fields[2] {
                "0" => false,
                "1" => true,
                _ => return None,
            },
            resolution: fields[3].parse().ok()?,
            tau: maybe(4)?,
            y_plus: maybe(5)?,
            value: maybe(6)?,
            reference: maybe(7)?,
            error: maybe(8)?,
            uncertainty: fields[9].parse().ok()?,
            cells: fields[10].parse().ok()?,
            steps: fields[11].parse().ok()?,
            updates: fields[12].parse().ok()?,
            cpu_seconds: fields[13].parse().ok()?,
            wall_seconds: fields[14].parse().ok()?,
            note: fields[15].into(),
        })
    }
}

/// The rows so far, all of which are on disk.
pub struct Table {
    path: PathBuf,
    /// The rows.
    pub rows: Vec<Row>,
}

impl Table {
    /// An empty table.
    pub fn create(path: &Path) -> riprap::Result<Self> {
        let table = Self {
            path: path.to_owned(),
            rows: Vec::new(),
        };
        table.write()?;
        Ok(table)
    }

    /// Reads the table of an earlier report.
    pub fn resume(path: &Path) -> riprap::Result<Self> {
        let text = std::fs::read_to_string(path).map_err(|error| Error::file(path, error))?;
        let lines = text.lines().enumerate().skip(1);
        let rows = lines.map(|(n, line)| {
            let wrong = || format!("line {} is no row of a report; remove it", n + 1);
            Row::parse(line).ok_or_else(|| Error::file(path, wrong()))
        });
        Ok(Self {
            rows: rows.collect::<riprap::Result<_>>()?,
            path: path.to_owned(),
        })
    }

    /// The row of a point, if it is there.
    pub fn find(&self, class: &str, point: &Point) -> Option<&Row> {
        self.rows
            .iter()
            .find(|row| row.class == class && row.is_of(point))
    }

    /// Adds a row.
    pub fn push(&mut self, row: Row) -> riprap::Result<()> {
        let opened = OpenOptions::new().append(true).open(&self.path);
        let written = opened.and_then(|mut file| writeln!(file, "{}", row.line()));
        written.map_err(|error| Error::file(&self.path, error))?;
        self.rows.push(row);
        Ok(())
    }

    /// Writes all rows again, after they have changed.
    pub fn write(&self) -> riprap::Result<()> {
        replace(&self.path, |file| {
            writeln!(file, "{HEAD}")?;
            self.rows
                .iter()
                .try_for_each(|row| writeln!(file, "{}", row.line()))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row() -> Row {
        Row {
            class: "sphere-array".into(),
            setting: "default at τ = 0.8".into(),
            default: true,
            resolution: 9.925,
            tau: Some(0.8),
            value: Some(1.02),
            cells: 4096,
            steps: 10,
            updates: 40960,
            cpu_seconds: 0.25,
            ..Row::default()
        }
    }

    #[test]
    fn a_line_gives_the_row_back() {
        let mut row = row();
        row.compare(Some(1.0), 1e-4);
        assert_eq!(Row::parse(&row.line()), Some(row));
    }

    #[test]
    fn a_report_goes_on_from_its_table() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("report.csv");
        let mut table = Table::create(&path).unwrap();
        table.push(row()).unwrap();
        let read = Table::resume(&path).unwrap();
        assert_eq!(read.rows, [row()]);
        std::fs::write(&path, format!("{HEAD}\nsphere-array,half a row")).unwrap();
        let error = Table::resume(&path).err().unwrap().to_string();
        assert!(error.contains("line 2"), "{error}");
    }

    #[test]
    fn what_is_no_row_is_none() {
        assert_eq!(Row::parse(HEAD), None);
        assert_eq!(Row::parse("sphere-array,default"), None);
        assert_eq!(Row::parse(&row().line().replace("0.25", "fast")), None);
    }

    #[test]
    fn a_reason_stays_in_its_field() {
        let mut row = row();
        row.take(Err(anyhow::anyhow!(
            "diverged at step 3, in cell [1, 2],\nstop"
        )));
        let read = Row::parse(&row.line());
        assert_eq!(read.map(|read| read.note), Some(row.note));
    }

    #[test]
    fn errors_are_of_the_reference_and_not_below_its_uncertainty() {
        let mut row = row();
        row.compare(Some(1.0), 0.03);
        assert!((row.error.unwrap_or_default() - 0.02).abs() < 1e-12);
        assert_eq!(row.certain_error(), Some(0.03));
        row.compare(None, 0.0);
        assert_eq!(row.error, Some(1.02));
    }
}
