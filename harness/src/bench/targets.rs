//! Which of the aims are met.

use super::{report::Row, variant};
use serde::Serialize;

/// An aim: what it says, what was found, and whether that is enough.
#[derive(Clone, Debug, Serialize)]
pub struct Target {
    /// Grid or part that it is of.
    pub of: String,
    /// What it says.
    pub says: &'static str,
    /// What was found.
    pub found: f64,
    /// The bound.
    pub limit: f64,
    /// Whether that is enough.
    pub met: bool,
}

impl Target {
    fn of(says: &'static str, found: f64, limit: f64, met: bool) -> Self {
        Self {
            of: String::new(),
            says,
            found,
            limit,
            met,
        }
    }

    /// An aim that `found` reaches.
    pub fn at_least(says: &'static str, found: f64, limit: f64) -> Self {
        let met = found >= limit;
        Self::of(says, found, limit, met)
    }

    /// An aim that `found` does not exceed.
    pub fn at_most(says: &'static str, found: f64, limit: f64) -> Self {
        let met = found <= limit;
        Self::of(says, found, limit, met)
    }
}

/// Prints one line about the aims of the fluid on a grid, and returns them.
pub fn print(grid: u32, rows: &[Row], software: bool) -> Vec<Target> {
    show(&format!("{grid}³"), targets(grid, rows, software))
}

/// Prints one line about the aims of something, and returns them as those of it.
pub fn show(of: &str, mut all: Vec<Target>) -> Vec<Target> {
    for target in &mut all {
        target.of = of.into();
    }
    let (met, missed): (Vec<_>, Vec<_>) = all.iter().partition(|t| t.met);
    let list = |some: &[&Target]| {
        let each = some.iter().map(|t| format!("{} ({:.3})", t.says, t.found));
        each.collect::<Vec<_>>().join(", ")
    };
    println!(
        "{of} targets: {} of {} met: {}{}{}",
        met.len(),
        all.len(),
        list(&met),
        if missed.is_empty() { "" } else { "; missed: " },
        list(&missed)
    );
    all
}

fn targets(grid: u32, rows: &[Row], software: bool) -> Vec<Target> {
    // The layout that the adapter likes best comes first.
    let find = |name, storage| {
        let mut same = rows.iter().filter(|r| r.grid == grid);
        same.find(|r| r.variant == name && r.storage == storage)
    };
    // How much longer than the plain step a variant takes, both beside the streaming of their group.
    let longer = |name| {
        let plain: &Row = find(variant::PLAIN, "f32")?;
        Some(plain.ratio_to_stream_only / find(name, "f32")?.ratio_to_stream_only)
    };
    let plain = find(variant::PLAIN, "f32");
    let half = find(variant::PLAIN, "f16");
    let mut all = Vec::new();
    let mut at_least = |says, found: Option<f64>, limit: f64| {
        all.extend(found.map(|found| Target::at_least(says, found, limit)));
    };
    if software {
        let ratio = plain.map(|r| r.ratio_to_stream_only);
        at_least("f32 MRT ≥ 0.8 of streaming", ratio, 0.8);
        at_least("f32 MRT ≥ 40 MLUPS", plain.map(|r| r.mlups), 40.0);
        at_least("16-bit MRT ≥ 35 MLUPS", half.map(|r| r.mlups), 35.0);
    } else {
        let share = |row: Option<&Row>| row.map(|r| r.share_of_copy);
        at_least("f32 MRT ≥ 0.8 of the copy", share(plain), 0.8);
        at_least("16-bit MRT ≥ 0.65 of the copy", share(half), 0.65);
    }
    let mut at_most = |says, found: Option<f64>, limit: f64| {
        all.extend(found.map(|found| Target::at_most(says, found, limit)));
    };
    at_most("MRT ≤ 1.1 BGK", longer("bgk").map(f64::recip), 1.1);
    at_most("WALE ≤ 1.6 of the plain step", longer("mrt, WALE"), 1.6);
    at_most("guard ≤ 1.01 of the plain step", longer("mrt, guard"), 1.01);
    all
}
