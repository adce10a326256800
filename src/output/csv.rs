//! CSV tables of probe measurements, one row per step, and their reader. A value that does not exist, such as the level of
//! a dry gauge, is `NaN`.

use super::{failure, replace};
use crate::{Error, Result};
use std::{
    cmp::Ordering,
    collections::VecDeque,
    fmt::Write as _,
    fs::{self, File},
    io::{ErrorKind, Write as _},
    path::{Path, PathBuf},
};

/// A growing table `step,time,…`; every row has been passed to the system when [`Csv::append`] returns.
#[derive(Debug)]
pub struct Csv {
    path: PathBuf,
    file: File,
    columns: usize,
    /// The step at which a run continues, and its existing rows that have not been written again.
    written: (u64, VecDeque<String>),
}

impl Csv {
    /// Begins a table at `path`, replacing an older one, with the header `step,time` and then `columns`.
    ///
    /// # Errors
    /// [`Error::File`] if a column's name holds a comma, a quote or a line break, or the file
    /// cannot be written.
    pub fn create<S: AsRef<str>>(path: impl Into<PathBuf>, columns: &[S]) -> Result<Self> {
        let path = path.into();
        let header = header(&path, columns)?;
        Self::begin(path, columns.len(), &header)
    }

    /// Continues the table at `path` for a run that restarts at `step`. Rows from that step on are dropped, since the run
    /// writes them again, and so is a truncated last row. If the run appends the rows of `step` itself, the old ones
    /// are written unchanged. Begins a new table if there is none.
    ///
    /// # Errors
    /// [`Error::File`] if the table has other columns, holds a row without a step, or cannot be
    /// read or written.
    pub fn resume<S: AsRef<str>>(
        path: impl Into<PathBuf>,
        columns: &[S],
        step: u64,
    ) -> Result<Self> {
        let path = path.into();
        let header = header(&path, columns)?;
        let text = match fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => String::new(),
            Err(error) => return Err(failure("read", &path, &error)),
        };
        let mut kept = header.clone();
        let mut written = VecDeque::new();
        for (number, line) in text.split_inclusive('\n').enumerate() {
            if number == 0 {
                if line.trim_end() != header.trim_end() {
                    let message = format!(
                        "its columns are `{}`, this run writes `{}`; \
                         move the file away, or write the same quantities as before",
                        line.trim_end(),
                        header.trim_end()
                    );
                    return Err(Error::file(path, message));
                }
                continue;
            }
            if !line.ends_with('\n') {
                break;
            }
            let found = line.split(',').next().unwrap_or_default().trim();
            let Ok(found) = found.parse::<u64>() else {
                let message = format!(
                    "line {}: `{found}` is not a step; mend or remove that line",
                    number + 1
                );
                return Err(Error::file(path, message));
            };
            match found.cmp(&step) {
                Ordering::Less => kept += line,
                Ordering::Equal => written.push_back(line.to_owned()),
                Ordering::Greater => {}
            }
        }
        let mut table = Self::begin(path, columns.len(), &kept)?;
        table.written = (step, written);
        Ok(table)
    }

    /// Adds a row: `step`, `time` (s), and a value for each column, with all digits that f64 needs.
    ///
    /// # Errors
    /// [`Error::File`] if the number of values differs from the number of columns, or the disk is full.
    pub fn append(&mut self, step: u64, time: f64, values: &[f64]) -> Result<()> {
        if values.len() != self.columns {
            return Err(Error::file(
                &self.path,
                format!(
                    "a row of {} values for {} columns; give one value per column",
                    values.len(),
                    self.columns
                ),
            ));
        }
        let (known, rows) = &mut self.written;
        let old = if *known == step {
            rows.pop_front()
        } else {
            None
        };
        let row = old.unwrap_or_else(|| row(step, time, values));
        // One call per row: a killed run ends between rows.
        self.file
            .write_all(row.as_bytes())
            .map_err(|error| failure("append to", &self.path, &error))
    }

    fn begin(path: PathBuf, columns: usize, content: &str) -> Result<Self> {
        replace(&path, |writer| writer.write_all(content.as_bytes()))?;
        let file = File::options()
            .append(true)
            .open(&path)
            .map_err(|error| failure("open", &path, &error))?;
        Ok(Self {
            path,
            file,
            columns,
            written: Default::default(),
        })
    }
}

fn row(step: u64, time: f64, values: &[f64]) -> String {
    let mut row = format!("{step},{time:?}");
    for value in values {
        // Writing to a String cannot fail.
        let _ = write!(row, ",{value:?}");
    }
    row.push('\n');
    row
}

fn header<S: AsRef<str>>(path: &Path, columns: &[S]) -> Result<String> {
    let mut header = String::from("step,time");
    for column in columns {
        let column = column.as_ref();
        if column.is_empty() || column.contains([',', '"', '\n', '\r']) {
            return Err(Error::file(
                path,
                format!(
                    "`{}` cannot name a column; use a name without comma, quote or line break",
                    column.escape_debug()
                ),
            ));
        }
        header.push(',');
        header += column;
    }
    header.push('\n');
    Ok(header)
}

/// A table of numbers, by columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Name and values of each column, in the order of the file.
    pub columns: Vec<(String, Vec<f64>)>,
}

impl Table {
    /// Reads a file of comma-separated numbers under one line of names. Empty lines do not count.
    ///
    /// # Errors
    /// [`Error::File`], with the line, if the file cannot be read, a row does not have one
    /// value per column, or a value is not a number.
    pub fn read(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let text = fs::read_to_string(path).map_err(|error| failure("read", path, &error))?;
        let mut lines = text.lines();
        let mut columns: Vec<(String, Vec<f64>)> = lines
            .next()
            .unwrap_or_default()
            .split(',')
            .map(|name| (name.trim().to_owned(), Vec::new()))
            .collect();
        // Other programs end files with empty lines.
        let rows = lines
            .enumerate()
            .filter(|(_, line)| !line.trim().is_empty());
        for (number, line) in rows {
            let place = number + 2;
            let values: Vec<&str> = line.split(',').collect();
            if values.len() != columns.len() {
                return Err(Error::file(
                    path,
                    format!(
                        "line {place}: {} values under {} names; mend or remove that line",
                        values.len(),
                        columns.len()
                    ),
                ));
            }
            for ((_, column), value) in columns.iter_mut().zip(values) {
                column.push(value.trim().parse().map_err(|_| {
                    Error::file(
                        path,
                        format!("line {place}: `{value}` is not a number; mend that line"),
                    )
                })?);
            }
        }
        Ok(Self { columns })
    }

    /// The values of the column called `name`.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        self.columns
            .iter()
            .find(|(column, _)| column == name)
            .map(|(_, values)| values.as_slice())
    }
}
