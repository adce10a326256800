//! Performance targets.

use serde::Serialize;

/// A target: its statement, the value found, and whether it is met.
#[derive(Clone, Debug, Serialize)]
pub struct Target {
    /// Kind of record: `target`.
    pub part: &'static str,
    /// Grid or part to which it applies.
    pub of: String,
    /// Statement of the target.
    pub says: &'static str,
    /// Value found.
    pub found: f64,
    /// The bound.
    pub limit: f64,
    /// Whether the target is met.
    pub met: bool,
}

impl Target {
    fn new(says: &'static str, found: f64, limit: f64, met: bool) -> Self {
        Self {
            part: "target",
            of: String::new(),
            says,
            found,
            limit,
            met,
        }
    }

    /// A target met if `found` ≥ `limit`; `None` if nothing was measured.
    pub fn at_least(says: &'static str, found: Option<f64>, limit: f64) -> Option<Self> {
        found.map(|found| Self::new(says, found, limit, found >= limit))
    }

    /// A target met if `found` ≤ `limit`; `None` if nothing was measured.
    pub fn at_most(says: &'static str, found: Option<f64>, limit: f64) -> Option<Self> {
        found.map(|found| Self::new(says, found, limit, found <= limit))
    }
}

/// Prints one line about the targets of a grid or part and returns them, labelled with it.
pub fn show(of: &str, aims: impl IntoIterator<Item = Option<Target>>) -> Vec<Target> {
    let mut all: Vec<Target> = aims.into_iter().flatten().collect();
    for target in &mut all {
        target.of = of.into();
    }
    let list = |met: bool| {
        let some = all.iter().filter(|target| target.met == met);
        let each = some.map(|target| format!("{} ({:.3})", target.says, target.found));
        each.collect::<Vec<_>>()
    };
    let (met, missed) = (list(true), list(false));
    println!(
        "{of} targets: {} of {} met: {}{}{}",
        met.len(),
        all.len(),
        met.join(", "),
        if missed.is_empty() { "" } else { "; missed: " },
        missed.join(", ")
    );
    all
}
