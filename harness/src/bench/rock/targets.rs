//! Which of the aims of the rock part are met.

use super::{cut, few, row::Row, step};
use crate::bench::targets::{Target, show};

/// Prints one line about the aims, and returns them.
pub fn print(rows: &[Row]) -> Vec<Target> {
    show("rock", targets(rows))
}

/// The aims of which there are rows.
pub fn targets(rows: &[Row]) -> Vec<Target> {
    let of = |kernel, variant| {
        let all = rows.iter().filter(move |row| row.kernel == kernel);
        all.filter(move |row| row.variant == variant)
    };
    let lowest = |kernel, variant, f: fn(&Row) -> Option<f64>| {
        of(kernel, variant).filter_map(f).reduce(f64::min)
    };
    let largest = |kernel, variant, f: fn(&Row) -> Option<f64>| {
        of(kernel, variant).filter_map(f).reduce(f64::max)
    };
    // That over all counts.
    let last = |kernel, variant| of(kernel, variant).next_back().and_then(|row| row.exponent);
    let mut all = Vec::new();
    for (says, found, limit) in [
        (
            "warm ≥ 200 000 contacts/s",
            lowest("contact", step::WARM, |row| Some(row.contacts_a_second)),
            2e5,
        ),
        (
            "cold ≥ 15 000 pairs/s",
            lowest("contact", step::COLD, |row| Some(row.pairs_a_second)),
            1.5e4,
        ),
    ] {
        all.extend(found.map(|found| Target::at_least(says, found, limit)));
    }
    for (says, found, limit) in [
        (
            "LP for ≤ 3 % of the pairs",
            largest("step", step::ONE_CORE, |row| {
                row.share_of_programs.map(|share| 100.0 * share)
            }),
            3.0,
        ),
        (
            "exponent of the step ≤ 1.1",
            last("step", step::ONE_CORE),
            1.1,
        ),
        (
            "exponent of the host's broadphase, sizes 1:1 ≤ 1.1",
            last("broadphase", "host, sizes 1:1"),
            1.1,
        ),
        (
            "exponent of the host's broadphase, sizes 1:100 ≤ 1.1",
            last("broadphase", "host, sizes 1:100"),
            1.1,
        ),
        (
            "exponent of the device's broadphase, sizes 1:1 ≤ 1.1",
            last("broadphase", "device, sizes 1:1"),
            1.1,
        ),
        (
            "exponent of the device's broadphase, sizes 1:100 ≤ 1.1",
            last("broadphase", "device, sizes 1:100"),
            1.1,
        ),
        (
            "10⁵ blocks cut in ≤ 10 s",
            of("cut", cut::CUBE)
                .find(|row| row.count >= 100_000)
                .map(|row| 1e-3 * row.ms),
            10.0,
        ),
        (
            "five fixed blocks cost ≤ 1.2 of one",
            largest("step", few::AMONG_FIVE, |row| row.ratio),
            1.2,
        ),
    ] {
        all.extend(found.map(|found| Target::at_most(says, found, limit)));
    }
    all
}
