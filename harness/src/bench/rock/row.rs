//! A result of the rock part, in the table and in the file.

use super::pile::Split;
use kit::{clock::Spent, exponent::exponent};
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
    /// What a call on so many boxes or blocks takes.
    pub fn new(
        kernel: &'static str,
        variant: impl Into<String>,
        count: usize,
        spent: Spent,
        basis: Basis,
    ) -> Self {
        let seconds = match basis {
            Basis::Cpu => spent.cpu,
            Basis::Wall => spent.wall,
        };
        Self {
            kernel,
            variant: variant.into(),
            count,
            pairs: 0,
            contacts: 0,
            ms_cpu: 1e3 * spent.cpu,
            ms_wall: 1e3 * spent.wall,
            ms: 1e3 * seconds,
            contacts_a_second: 0.0,
            pairs_a_second: 0.0,
            share_of_programs: None,
            exponent: None,
            largest_speed: None,
            ratio: None,
            split: None,
        }
    }

    /// Prints the row and puts it after the others, with its rates and the exponent up to it.
    pub fn push(mut self, rows: &mut Vec<Self>) {
        let alike = |other: &&Self| other.kernel == self.kernel && other.variant == self.variant;
        let all = rows.iter().filter(alike).chain([&self]);
        let points: Vec<_> = all.map(|row| (row.count as f64, row.ms)).collect();
        self.exponent = exponent(&points);
        self.contacts_a_second = 1e3 * self.contacts as f64 / self.ms;
        self.pairs_a_second = 1e3 * self.pairs as f64 / self.ms;
        println!("{self}");
        rows.push(self);
    }
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
