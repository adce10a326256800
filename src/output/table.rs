//! Reading back what [`Csv`](super::Csv) wrote.

use super::replace::failure;
use crate::{Error, Result};
use std::fs;
use std::path::Path;

/// A table of numbers, by columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Name and values of each column, in the order of the file.
    pub columns: Vec<(String, Vec<f64>)>,
}

impl Table {
    /// Reads a file of comma-separated numbers under one line of names.
    ///
    /// # Errors
    /// [`Error::File`], with the line, if the file cannot be read, a row has not one value a
    /// column, or a value is no number.
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
        for (number, line) in lines.enumerate() {
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
