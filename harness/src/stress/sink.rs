//! Where cells go: a table and a list on disk that grow with each, and lines on the terminal.

use super::{Cell, cell::COLUMNS};
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
    table: File,
    cells: Vec<Cell>,
}

impl Sink {
    /// An empty table and list in `folder`.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn begin(folder: &Path) -> Result<Self> {
        std::fs::create_dir_all(folder)
            .with_context(|| format!("cannot make {}", folder.display()))?;
        let path = folder.join("stress.csv");
        let mut table =
            File::create(&path).with_context(|| format!("cannot write {}", path.display()))?;
        writeln!(table, "{COLUMNS}")?;
        let sink = Self {
            folder: folder.to_owned(),
            table,
            cells: Vec::new(),
        };
        sink.list()?;
        Ok(sink)
    }

    /// Writes a cell to both files and tells it.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn add(&mut self, cell: Cell) -> Result<()> {
        println!("{}", line(&cell));
        // One call a row: a killed stress ends between rows.
        self.table
            .write_all((cell.row() + "\n").as_bytes())
            .with_context(|| format!("cannot write {}/stress.csv", self.folder.display()))?;
        self.cells.push(cell);
        self.list()
    }

    fn list(&self) -> Result<()> {
        let text = serde_json::to_string_pretty(&self.cells)? + "\n";
        Ok(replace(&self.folder.join("stress.json"), |file| {
            file.write_all(text.as_bytes())
        })?)
    }

    /// The cells of a map.
    pub fn of(&self, map: &str) -> Vec<&Cell> {
        self.cells.iter().filter(|cell| cell.map == map).collect()
    }

    /// Where the files are.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// All of them.
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
    use crate::stress::Outcome;

    #[test]
    fn what_was_added_is_on_disk_before_the_end() {
        let folder = std::env::temp_dir().join(format!("riprap-stress-{}", std::process::id()));
        let mut sink = Sink::begin(&folder).unwrap();
        for steps in 1..=2 {
            sink.add(Cell {
                map: "a".into(),
                panel: String::new(),
                y: "1".into(),
                x: "2".into(),
                outcome: Outcome::Ended,
                value: None,
                quantity: "q".into(),
                steps,
                warned: String::new(),
                agrees: None,
                seconds: 0.0,
                detail: String::new(),
            })
            .unwrap();
            let table = std::fs::read_to_string(folder.join("stress.csv")).unwrap();
            assert_eq!(table.lines().count(), 1 + steps as usize);
            let list = std::fs::read_to_string(folder.join("stress.json")).unwrap();
            let list: serde_json::Value = serde_json::from_str(&list).unwrap();
            assert_eq!(list.as_array().unwrap().len(), steps as usize);
            assert_eq!(list[0]["outcome"], "ended");
        }
        std::fs::remove_dir_all(folder).unwrap();
    }
}
