//! `riprap stress`: maps of where the methods are stable and where they fail; each run completes, or stops with an error.
//!
//! A map is a function that runs one cell after the other and hands each to a [`Sink`], which writes it to disk before the next
//! begins. The short form has coarse axes and short runs, and says so; `--full` runs everything.

mod bed;
mod cell;
mod density;
mod long;
mod packed;
mod places;
mod restarts;
mod shear_layer;
mod sink;
mod stiffness;
mod tally;

pub use cell::{Cell, Outcome};
pub use sink::Sink;

use crate::{
    bench::Machine,
    picture::{ColourGrid, GridPanel, Square},
    validate::CaseContext,
};
use plotters::style::RGBColor;
use riprap::scene::Advice;
use std::{path::PathBuf, time::Instant};

/// Maps where the methods are stable, and tries what may break them; writes stress.csv, stress.json and a picture of
/// each map.
///
/// The short form takes six minutes on two quiet cores, with coarse axes and short runs. A run that is killed keeps every
/// finished cell.
#[derive(Clone, Debug, clap::Args)]
pub struct Args {
    /// Fine axes and long runs; takes hours on a CPU
    #[arg(long)]
    pub full: bool,
    /// Only this map
    #[arg(long, value_name = "NAME", value_parser = names())]
    pub only: Option<String>,
    /// Folder for the results
    #[arg(long, value_name = "DIR", default_value = "out/stress")]
    pub out: PathBuf,
    /// Part of the name of the adapter to use
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
}

/// Warnings in the format of [`Cell::warned`].
fn warned(advice: &Advice) -> String {
    let places: Vec<_> = advice.iter().map(|warning| &*warning.place).collect();
    match places.is_empty() {
        true => String::new(),
        false => format!("warned {}", places.join(" ")),
    }
}

/// Number of bytes that differ between two states.
fn bytes_that_differ(a: &[u8], b: &[u8]) -> usize {
    let both = a.iter().zip(b).filter(|(a, b)| a != b);
    both.count() + a.len().abs_diff(b.len())
}

/// Runs and draws the maps. Returns whether no message was unclear and no judged value missed its limit.
pub fn run(args: &Args) -> anyhow::Result<bool> {
    let context = CaseContext::open(args.adapter.as_deref(), args.full)?;
    let mut sink = Sink::begin(&args.out, Machine::of(&context.device.adapter_info()))?;
    let begin = Instant::now();
    let wanted = |map: &&Map| args.only.as_ref().is_none_or(|only| only == map.name);
    for map in MAPS.iter().filter(wanted) {
        let before = Instant::now();
        println!("{}: {}", map.name, map.title);
        println!("  {}", map.extent(args.full));
        (map.run)(&context, &mut sink)?;
        map.draw(&sink)?;
        for line in map.summary(&sink.of(map.name)) {
            println!("  {line}");
        }
        println!("  {:.0} s", before.elapsed().as_secs_f64());
    }
    let defects = sink.cells().iter().filter(|cell| cell.outcome.is_defect());
    let defects = defects.count();
    println!(
        "{} cells, {defects} defects, {:.0} s; in {}",
        sink.cells().len(),
        begin.elapsed().as_secs_f64(),
        sink.folder().display()
    );
    Ok(defects == 0)
}

/// A map.
#[derive(Clone, Copy, Debug)]
pub struct Map {
    /// Its name, as `--only` takes it; its picture is `NAME.png`.
    pub name: &'static str,
    /// Its title.
    pub title: &'static str,
    /// Label of the horizontal axis.
    pub x: &'static str,
    /// Label of the vertical axis.
    pub y: &'static str,
    /// Extent of the short form.
    pub short: &'static str,
    /// Extent of the full form.
    pub full: &'static str,
    /// Runs its cells.
    pub run: fn(&CaseContext, &mut Sink) -> anyhow::Result<()>,
}

/// All maps, in the order in which they run.
pub const MAPS: &[Map] = &[
    shear_layer::MAP,
    density::MAP,
    stiffness::MAP,
    packed::MAP,
    bed::MAP,
    places::MAP,
    long::MAP,
    restarts::MAP,
];

/// Names of all maps.
pub fn names() -> Vec<&'static str> {
    MAPS.iter().map(|map| map.name).collect()
}

/// Completed.
const GOOD: RGBColor = RGBColor(170, 217, 160);
/// Stable, but wrong.
const UNPHYSICAL: RGBColor = RGBColor(250, 205, 110);
/// Left the range of the method.
const DIVERGED: RGBColor = RGBColor(232, 130, 115);
/// Refused, or ended by another error.
const OTHER: RGBColor = RGBColor(190, 190, 205);
/// To be fixed.
const DEFECT: RGBColor = RGBColor(225, 110, 220);

impl Map {
    /// Describes the extent of the short or the full form.
    pub fn extent(&self, full: bool) -> String {
        match full {
            true => format!("whole: {}", self.full),
            false => format!("short: {}; --full: {}", self.short, self.full),
        }
    }

    /// Counts of the outcomes of its cells, and of advice that was right or wrong.
    pub fn summary(&self, cells: &[&Cell]) -> Vec<String> {
        let mut kinds: Vec<(String, usize)> = Vec::new();
        for cell in cells {
            let name = cell.outcome.to_string();
            match kinds.iter_mut().find(|(known, _)| *known == name) {
                Some((_, count)) => *count += 1,
                None => kinds.push((name, 1)),
            }
        }
        let kinds: Vec<_> = kinds
            .iter()
            .map(|(name, count)| format!("{count} {name}"))
            .collect();
        let mut lines = vec![kinds.join(", ")];
        let judged = cells.iter().filter(|cell| cell.agrees.is_some()).count();
        if judged > 0 {
            let wrong = cells.iter().filter(|cell| cell.agrees == Some(false));
            let (wrong, refused): (Vec<&&Cell>, Vec<&&Cell>) =
                wrong.partition(|cell| !cell.warned.starts_with("refused"));
            let needless = cells
                .iter()
                .filter(|cell| cell.agrees.is_some() && cell.outcome.is_good())
                .filter(|cell| cell.warned.starts_with("warned"));
            lines.push(format!(
                "advice: {} of {judged} cells disagree: {} ended badly without a warning, {} were refused that end well; \
                 {} were warned of that end well, some for accuracy",
                wrong.len() + refused.len(),
                wrong.len(),
                refused.len(),
                needless.count()
            ));
        }
        lines
    }

    /// Draws its picture in the folder of the sink.
    pub fn draw(&self, sink: &Sink) -> anyhow::Result<()> {
        let cells = sink.of(self.name);
        let first = |of: fn(&Cell) -> &String| {
            let mut all: Vec<String> = Vec::new();
            for cell in &cells {
                if !all.contains(of(cell)) {
                    all.push(of(cell).clone());
                }
            }
            all
        };
        let (panels, columns, rows) = (first(|c| &c.panel), first(|c| &c.x), first(|c| &c.y));
        if cells.is_empty() {
            return Ok(());
        }
        let square = |cell: &&Cell| Square {
            colour: colour(&cell.outcome),
            label: cell.label(),
            marked: !cell.warned.is_empty(),
            framed: cell.agrees == Some(false) || cell.outcome.is_defect(),
        };
        let panel = |name: &String| GridPanel {
            title: name.clone(),
            squares: rows
                .iter()
                .flat_map(|y| columns.iter().map(move |x| (x, y)))
                .map(|(x, y)| {
                    let here = |c: &&&Cell| c.panel == *name && c.x == *x && c.y == *y;
                    cells.iter().find(here).map(square)
                })
                .collect(),
        };
        let panels = panels.iter().map(panel).collect();
        let key = |text: &str, colour| (text.to_owned(), colour);
        ColourGrid {
            title: self.title.into(),
            x: self.x.into(),
            y: self.y.into(),
            quantity: format!(
                "number: {}; @: step; dot: warned or refused beforehand; framed: to be looked at",
                cells[0].quantity
            ),
            columns,
            rows,
            panels,
            key: vec![
                key("ended", GOOD),
                key("unphysical", UNPHYSICAL),
                key("diverged", DIVERGED),
                key("other error", OTHER),
                key("defect", DEFECT),
            ],
        }
        .draw(&sink.folder().join(format!("{}.png", self.name)))
    }
}

fn colour(outcome: &Outcome) -> RGBColor {
    match outcome {
        Outcome::Ended => GOOD,
        Outcome::Unphysical => UNPHYSICAL,
        Outcome::Error(name) if name == "Diverged" => DIVERGED,
        Outcome::Error(_) => OTHER,
        Outcome::OverLimit | Outcome::Unclear(_) => DEFECT,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_differ_and_are_file_names() {
        let all = names();
        for (n, name) in all.iter().enumerate() {
            assert!(name.bytes().all(|b| b.is_ascii_lowercase() || b == b'_'));
            assert!(!all[..n].contains(name));
        }
    }
}
