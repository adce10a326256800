//! A result of the rock part, in the table and in the file.

use super::{core::Cost, split::Split};
use crate::bench::report::Machine;
use kit::exponent::exponent;
use serde::Serialize;
use std::fmt;

/// What one kernel takes for one number of blocks or boxes.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// `cut`, `broadphase`, `contact` or `step`.
    pub kernel: &'static str,
    /// What it is done on, and by what.
    pub variant: String,
    /// Boxes of the broadphase, blocks that a cut makes, free blocks otherwise.
    pub count: usize,
    /// Pairs that a call finds or looks at.
    pub pairs: usize,
    /// Contacts of a call.
    pub contacts: usize,
    /// Milliseconds of CPU time a call, the least of some.
    pub ms_cpu: f64,
    /// Milliseconds a call by the clock on the wall, the least of some.
    pub ms_wall: f64,
    /// The one of these two that is the cost: wall time on a GPU and on all cores, else CPU time.
    pub ms: f64,
    /// Contacts over the cost of all pairs.
    pub contacts_a_second: f64,
    /// Pairs over the cost.
    pub pairs_a_second: f64,
    /// Share of the pairs that took a linear program.
    pub share_of_programs: Option<f64>,
    /// p of cost ∝ countᵖ over this count and those before it of the same variant.
    pub exponent: Option<f64>,
    /// Speed of the fastest free block, m/s.
    pub largest_speed: Option<f64>,
    /// Cost over that of the variant that it is compared with.
    pub ratio: Option<f64>,
    /// Where the time of a step goes.
    pub split: Option<Split>,
    /// Where and when.
    #[serde(flatten)]
    pub machine: Machine,
}

/// What a call does.
#[derive(Clone, Debug)]
pub struct Done {
    /// Kernel.
    pub kernel: &'static str,
    /// Variant.
    pub variant: String,
    /// Boxes or free blocks.
    pub count: usize,
    /// Pairs.
    pub pairs: usize,
    /// Contacts.
    pub contacts: usize,
}

/// Which time is the cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// CPU time.
    Cpu,
    /// Time by the clock on the wall.
    Wall,
}

impl Row {
    /// What was done, at what cost.
    pub fn new(machine: &Machine, done: Done, cost: Cost, basis: Basis) -> Self {
        let seconds = match basis {
            Basis::Cpu => cost.cpu,
            Basis::Wall => cost.wall,
        };
        Self {
            kernel: done.kernel,
            variant: done.variant,
            count: done.count,
            pairs: done.pairs,
            contacts: done.contacts,
            ms_cpu: 1e3 * cost.cpu,
            ms_wall: 1e3 * cost.wall,
            ms: 1e3 * seconds,
            contacts_a_second: done.contacts as f64 / seconds,
            pairs_a_second: done.pairs as f64 / seconds,
            share_of_programs: None,
            exponent: None,
            largest_speed: None,
            ratio: None,
            split: None,
            machine: machine.clone(),
        }
    }

    fn is_like(&self, other: &Self) -> bool {
        self.kernel == other.kernel && self.variant == other.variant
    }
}

/// Prints a row and puts it after the others, with the exponent up to it.
pub fn push(rows: &mut Vec<Row>, mut row: Row) {
    let all = rows.iter().filter(|other| other.is_like(&row));
    let points: Vec<_> = all
        .chain([&row])
        .map(|row| (row.count as f64, row.ms))
        .collect();
    row.exponent = exponent(&points);
    println!("{row}");
    rows.push(row);
}

/// Heads of the columns of a row.
pub const HEAD: &str = "kernel      variant                               count     pairs  contacts |     ms CPU    ms wall | contacts/s    pairs/s    LP     p  ratio";

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let or_dash = |text: Option<String>| text.unwrap_or_else(|| "-".into());
        write!(
            f,
            "{:<11} {:<34} {:>8} {:>9} {:>9} | {:>10.4} {:>10.4} | {:>10.0} {:>10.0} {:>5} {:>5} {:>6}",
            self.kernel,
            self.variant,
            self.count,
            self.pairs,
            self.contacts,
            self.ms_cpu,
            self.ms_wall,
            self.contacts_a_second,
            self.pairs_a_second,
            or_dash(self.share_of_programs.map(|s| format!("{:.1}%", 100.0 * s))),
            or_dash(self.exponent.map(|p| format!("{p:.2}"))),
            or_dash(self.ratio.map(|r| format!("{r:.2}"))),
        )?;
        match &self.split {
            Some(split) => write!(f, "\n            {split}"),
            None => Ok(()),
        }
    }
}
