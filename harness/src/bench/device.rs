//! `riprap bench --device`: one record of a GPU, within four minutes: the table of kernels with their shares of the copy
//! bandwidth, the crossover of the searches for pairs, and the short validation cases on the device.

use super::{
    Bench, Measured,
    rock::crossover,
    table::{self, Extent},
};
use crate::validate::{self, Case, CaseContext};
use serde::Serialize;
use std::time::Instant;

/// Cases that take minutes on two cores: they come last, and are left out if time is short.
const LONG: &str = "cavity/* wake/* stability/* solids/array* solids/cylinder solids/spike solids/rotation \
    solids/lubrication solids/release";

/// A case for which no time was left.
#[derive(Clone, Debug, Serialize)]
pub struct SkippedCase {
    /// Kind of record: `left out`.
    part: &'static str,
    /// Name of the case.
    case: &'static str,
}

/// Measures the device, and prints tables as it goes. A validation case that fails is a result, not an error.
pub fn measure(bench: &Bench<'_>, budget: Option<u64>) -> anyhow::Result<Vec<Measured>> {
    let begin = Instant::now();
    let (extent, patience) = match bench.machine.software {
        // A rehearsal, with more time.
        true => (
            Extent {
                grids: &[64, 128],
                ..Extent::ALL
            },
            300.0,
        ),
        false => (
            Extent {
                grids: &[128, 256],
                row: 12.0,
                whole: 80.0,
            },
            80.0,
        ),
    };
    let table = table::measure(bench, budget, extent)?;
    let mut measured: Vec<_> = table.into_iter().map(Measured::Table).collect();
    let (rows, crossings) = crossover(bench)?;
    measured.extend(rows.into_iter().map(Measured::Rock));
    measured.extend(crossings.into_iter().map(Measured::Crossover));

    let context = CaseContext::on(bench.device, bench.queue);
    println!("\n{}", validate::record::header());
    let start = Instant::now();
    let (mut judged, mut failed) = (0, 0);
    for case in cases()? {
        if start.elapsed().as_secs_f64() > patience {
            println!(
                "{}: left out, the {patience:.0} s of validation are over",
                case.name
            );
            measured.push(Measured::LeftOut(SkippedCase {
                part: "left out",
                case: case.name,
            }));
            continue;
        }
        for record in validate::found(&context, &case) {
            judged += usize::from(record.limit.is_some());
            failed += usize::from(!record.passed);
            measured.push(Measured::Validation(record));
        }
    }
    println!(
        "{} of {judged} checks passed; {:.0} s in all",
        judged - failed,
        begin.elapsed().as_secs_f64()
    );
    Ok(measured)
}

/// The short cases that use the device, those that take long last.
fn cases() -> anyhow::Result<Vec<Case>> {
    let patterns: Result<Vec<_>, _> = LONG.split_whitespace().map(glob::Pattern::new).collect();
    let patterns = patterns?;
    let long = |case: &Case| patterns.iter().any(|pattern| pattern.matches(case.name));
    // Dry blocks and the linker need no device.
    let on_host = |case: &Case| {
        let family = case.name.split('/').next();
        (matches!(family, Some("rock" | "dda")) && case.name != "rock/broadphase")
            || case.name == "kernels/slots"
    };
    let mut cases = validate::select(None)?;
    cases.retain(|case| !case.only_full && !on_host(case));
    cases.sort_by_key(long);
    Ok(cases)
}
