//! Variants, and a linked kernel as drivers see it.

use super::translate::translate;
use riprap::{
    gpu::{kernel::bindings, link::Linked},
    lattice::{Force, Grid, Setup, Storage, constants},
};
use std::collections::{BTreeSet, HashMap};

/// Numbers of bindings that spread 27 directions in every manner required by the limits of devices.
pub const BINDINGS: [u32; 6] = [1, 2, 4, 7, 14, 27];
/// Storage, lanes, and whether words have 64 bits.
pub const LAYOUTS: [(Storage, u32, bool); 6] = [
    (Storage::F32, 1, false),
    (Storage::F32, 4, false),
    (Storage::F32, 4, true),
    (Storage::F16, 2, false),
    (Storage::F16, 4, false),
    (Storage::F16, 4, true),
];

/// The kinds of body force.
pub fn forces() -> [Force; 3] {
    [
        Force::None,
        Force::Constant([1e-6; 3]),
        Force::Field(vec![[1e-6; 3]; 64]),
    ]
}

/// All combinations of the choices that a setup offers, as indices.
pub fn variants(counts: &[usize]) -> impl Iterator<Item = Vec<usize>> {
    let counts = counts.to_vec();
    (0..counts.iter().product()).map(move |mut n| {
        let digit = |count: &usize| {
            let digit = n % count;
            n /= count;
            digit
        };
        counts.iter().map(digit).collect()
    })
}

/// A third of [`variants`]. If at least five of the choices have three values or more, the values of any four choices occur in
/// all combinations, so that errors of a slot in combination with one or two others are detected.
pub fn third_of_variants(counts: &[usize]) -> impl Iterator<Item = Vec<usize>> {
    variants(counts).filter(|variant| {
        let weighted = variant.iter().zip([1, 2].into_iter().cycle());
        weighted
            .map(|(value, weight)| value * weight)
            .sum::<usize>()
            % 3
            == 0
    })
}

/// The number of bindings of a variant. Each number occurs with each value of each choice, because the sum of the other
/// choices runs through all remainders.
pub fn bindings_of(variant: &[usize]) -> u32 {
    BINDINGS[variant.iter().sum::<usize>() % BINDINGS.len()]
}

/// Applies naga's last steps before a shader reaches the driver: overrides become numbers, their expressions are evaluated and
/// validated, and the module is translated to the language of the driver.
pub fn specialise(linked: &Linked, entry: &str, setup: &Setup, odd: bool) {
    let grid = Grid::new(setup).unwrap();
    let mut numbers: HashMap<String, f64> = [
        ("BRICKS", 1.0),
        ("GUARD_COUNTS", 1.0),
        ("NON_EQUILIBRIUM", 1.0),
        ("LINKS_OF_ROW", 8.0),
        ("LINKS_OF_INVOCATION", 8.0),
        ("AXIS", 2.0),
    ]
    .into_iter()
    .chain(constants(setup, &grid, odd))
    .map(|(name, value)| (name.into(), value))
    .collect();
    numbers.retain(|name, _| linked.declares(name));
    translate(linked, entry, &numbers, setup.is_wide());
}

/// Names of the buffers other than the populations, and the number of population buffers.
pub fn names(linked: &Linked, entry: &str) -> (BTreeSet<String>, usize) {
    let (populations, others): (Vec<_>, Vec<_>) = bindings(linked, entry)
        .unwrap()
        .into_iter()
        .map(|binding| binding.name)
        .partition(|name| name.starts_with("populations_"));
    (others.into_iter().collect(), populations.len())
}
