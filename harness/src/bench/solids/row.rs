//! A number of the solids part, in the table and in the file.

use crate::bench::report::Machine;
use serde::Serialize;
use std::fmt;

/// One number.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// What: `solids`.
    pub part: &'static str,
    /// What it is.
    pub name: String,
    /// What was run.
    pub setup: String,
    /// The number: times are CPU time over the cores on software adapters, else time by the clock on the wall.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// Where and when.
    #[serde(flatten)]
    pub machine: Machine,
}

impl Row {
    /// A number of this machine.
    pub fn new(machine: &Machine, name: &str, setup: &str, value: f64, unit: &'static str) -> Self {
        Self {
            part: "solids",
            name: name.into(),
            setup: setup.into(),
            value,
            unit,
            machine: machine.clone(),
        }
    }
}

/// Heads of the columns of a row.
pub const HEAD: &str = "what                                          value unit   of";

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{:<40} {:>10.3} {:<4}   {}",
            self.name, self.value, self.unit, self.setup
        )
    }
}
