//! Which of the aims are met.

use serde::Serialize;

/// An aim: what it says, what was found, and whether that is enough.
#[derive(Clone, Debug, Serialize)]
pub struct Target {
    /// What: `target`.
    pub part: &'static str,
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

    /// An aim that `found` reaches; none of what was not measured.
    pub fn at_least(says: &'static str, found: Option<f64>, limit: f64) -> Option<Self> {
        found.map(|found| Self::new(says, found, limit, found >= limit))
    }

    /// An aim that `found` does not exceed; none of what was not measured.
    pub fn at_most(says: &'static str, found: Option<f64>, limit: f64) -> Option<Self> {
        found.map(|found| Self::new(says, found, limit, found <= limit))
    }
}

/// Prints one line about the aims of something, and returns them as those of it.
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
