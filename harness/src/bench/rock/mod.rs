//! The rock part: cutting, contacts, the search for pairs, the step of all blocks.

mod contact;
mod core;
mod cut;
mod few;
mod row;
mod search;
mod split;
mod step;
mod targets;

pub use kit::exponent::exponent;
pub use row::Row;

use super::{Bench, report::Machine, targets::Target};
use core::Core;
use riprap::Result;

/// How much is measured.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Numbers of free blocks in piles, about.
    pub piles: Vec<usize>,
    /// Numbers of boxes for the broadphase.
    pub items: Vec<usize>,
    /// Samples, of which the fastest counts.
    pub rounds: usize,
}

impl Plan {
    /// Up to a thousand blocks where it must be `quick`, to ten thousand, or in `full` to a hundred
    /// thousand, which takes long to come to rest.
    pub fn new(quick: bool, full: bool) -> Self {
        let (blocks, boxes, rounds) = match (quick, full) {
            (_, true) => (5, 5, 9),
            (true, _) => (3, 4, 5),
            (false, false) => (4, 5, 9),
        };
        let powers = |largest| (2..=largest).map(|k| 10usize.pow(k)).collect();
        Self {
            piles: powers(blocks),
            items: powers(boxes),
            rounds,
        }
    }
}

/// Measures all of the plan and prints a table as it goes; without a device, the host's part.
///
/// # Errors
/// If the device fails, or a step.
pub fn measure(
    plan: &Plan,
    device: Option<&Bench<'_>>,
    machine: &Machine,
) -> Result<(Vec<Row>, Vec<Target>)> {
    println!(
        "\nrock: the fastest of {} samples\n{}",
        plan.rounds,
        row::HEAD
    );
    let core = Core::new()?;
    let mut rows = Vec::new();
    cut::measure(plan, machine, &mut rows)?;
    search::measure(plan, &core, device, machine, &mut rows)?;
    few::measure(plan, &core, machine, &mut rows)?;
    step::measure(plan, &core, machine, &mut rows)?;
    let targets = targets::print(&rows);
    Ok((rows, targets))
}
