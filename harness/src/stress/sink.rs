//! Output of cells: a table and a list on disk that grow with each, and lines on the terminal.

use super::{
    Cell,
    cell::{COLUMNS, quoted},
};
use crate::bench::Machine;
use anyhow::{Context, Result};
use riprap::output::replace;
use std::{
    fs::File,
    io::Write,
    path::{Path, PathBuf},
};

/// The cells so far, which are on disk already.
#[derive(Debug)]
pub struct Sink {
    folder: PathBuf,
    machine: Machine,
    table: File,
    cells: Vec<Cell>,
}

impl Sink {
    /// Starts an empty table and list in `folder`, for results of this machine.
    pub fn begin(folder: &Path, machine: Machine) -> Result<Self> {
        std::fs::create_dir_all(folder)
            .with_context(|| format!("cannot make {}", folder.display()))?;
        let path = folder.join("stress.csv");
        let mut table =
            File::create(&path).with_context(|| format!("cannot write {}", path.display()))?;
        writeln!(table, "{COLUMNS},adapter,driver,commit,date")?;
        let sink = Self {
            folder: folder.to_owned(),
            machine,
            table,
            cells: Vec::new(),
        };
        sink.list()?;
        Ok(sink)
    }

    /// Writes a cell to both files and prints it.
    pub fn add(&mut self, cell: Cell) -> Result<()> {
        println!("{}", line(&cell));
        // One write per row: a killed run ends between rows.
        let Machine {
            adapter,
            driver,
            commit,
            date,
            ..
        } = &self.machine;
        let commit = commit.as_deref().unwrap_or_default();
        let row = [&cell.row(), &quoted(adapter), &quoted(driver), commit, date].join(",");
        self.table
            .write_all((row + "\n").as_bytes())
            .with_context(|| format!("cannot write {}/stress.csv", self.folder.display()))?;
        self.cells.push(cell);
        self.list()
    }

    fn list(&self) -> Result<()> {
        let text = self.machine.json(&self.cells)?;
        Ok(replace(&self.folder.join("stress.json"), |file| {
            file.write_all(text.as_bytes())
        })?)
    }

    /// The cells of a map.
    pub fn of(&self, map: &str) -> Vec<&Cell> {
        self.cells.iter().filter(|cell| cell.map == map).collect()
    }

    /// Folder of the files.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// All cells.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }
}

/// A cell as a line of the table on the terminal.
fn line(cell: &Cell) -> String {
    let value = cell.value.map_or(String::from("-"), |v| format!("{v:.4e}"));
    let mut text = format!(
        "  {:28} {:>24} {:>9}  {:14} {value:>11} {:>7} {:>6.1} s",
        cell.panel,
        cell.y,
        cell.x,
        cell.outcome.to_string(),
        cell.steps,
        cell.seconds
    );
    if !cell.warned.is_empty() {
        text += &format!("  {}", cell.warned);
    }
    if cell.agrees == Some(false) {
        text += "  <- the advice says otherwise";
    }
    if cell.outcome.is_defect() {
        text += &format!("\n      {}", cell.detail);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_added_is_on_disk_before_the_end() {
        let scratch = tempfile::tempdir().unwrap();
        let folder = scratch.path();
        let mut sink = Sink::begin(folder, Machine::host()).unwrap();
        for steps in 1..=2 {
            let cell = Cell::new("a", "", "1".into(), "2".into(), "q");
            sink.add(Cell { steps, ..cell }).unwrap();
            let table = std::fs::read_to_string(folder.join("stress.csv")).unwrap();
            assert_eq!(table.lines().count(), 1 + steps as usize);
            let list = std::fs::read_to_string(folder.join("stress.json")).unwrap();
            let list: serde_json::Value = serde_json::from_str(&list).unwrap();
            assert_eq!(list.as_array().unwrap().len(), steps as usize);
            assert_eq!(list[0]["outcome"], "ended");
            assert_eq!(list[0]["adapter"], "no adapter");
            let lengths: Vec<_> = table.lines().map(|row| row.split(',').count()).collect();
            assert!(lengths.iter().all(|n| *n == lengths[0]), "{table}");
        }
    }
}
