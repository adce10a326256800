//! The maps there are, and what is the same for all of them.

use super::{Cell, Outcome, Sink, density, long, packed, places, restarts, shear_layer, stiffness};
use crate::{
    picture::{ColourGrid, GridPanel, Square},
    validate::Stand,
};
use plotters::style::RGBColor;

/// A map.
#[derive(Clone, Copy, Debug)]
pub struct Map {
    /// Its name, as `--only` takes it; its picture is `NAME.png`.
    pub name: &'static str,
    /// What it shows.
    pub title: &'static str,
    /// What its horizontal axis is.
    pub x: &'static str,
    /// What its vertical axis is.
    pub y: &'static str,
    /// How much of it the short form has.
    pub short: &'static str,
    /// And the whole.
    pub full: &'static str,
    /// Runs its cells.
    pub run: fn(&Stand, &mut Sink) -> anyhow::Result<()>,
}

/// All maps, in the order in which they run.
pub const MAPS: &[Map] = &[
    shear_layer::MAP,
    density::MAP,
    stiffness::MAP,
    packed::MAP,
    places::MAP,
    long::MAP,
    restarts::MAP,
];

/// Their names.
pub fn names() -> Vec<&'static str> {
    MAPS.iter().map(|map| map.name).collect()
}

/// Came to its end.
const GOOD: RGBColor = RGBColor(170, 217, 160);
/// Stable, and wrong.
const UNPHYSICAL: RGBColor = RGBColor(250, 205, 110);
/// Left the range of the method.
const DIVERGED: RGBColor = RGBColor(232, 130, 115);
/// Refused, or ended by another error.
const OTHER: RGBColor = RGBColor(190, 190, 205);
/// To be mended.
const DEFECT: RGBColor = RGBColor(225, 110, 220);

impl Map {
    /// How far this form of it goes, in words.
    pub fn extent(&self, full: bool) -> String {
        match full {
            true => format!("whole: {}", self.full),
            false => format!("short: {}; --full: {}", self.short, self.full),
        }
    }

    /// Counts of what became of its cells, and how far the advice was right.
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

    /// Its picture, in the folder of the sink.
    ///
    /// # Errors
    /// If the file cannot be written.
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
