//! What a run did not do because its scene did not need it.

use super::{flow::Coupling, rock::Rocks, water::Pool};
use riprap::lattice::{Force, Lattice};
use serde::Serialize;
use std::fmt;

/// Work of one kind: how much of it was done, of how much that a program without this shortcut does.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeftOut {
    /// What was left out, and why.
    pub what: String,
    /// What was done.
    pub done: f64,
    /// Of how much.
    pub of: f64,
}

impl LeftOut {
    /// Nothing if nothing was spared.
    fn some(what: &str, done: f64, of: f64) -> Option<Self> {
        let what = what.to_owned();
        (done < of).then_some(Self { what, done, of })
    }

    /// What the kernels of a lattice do without, and its bricks without water: before any step.
    pub fn of_lattice(lattice: &Lattice) -> Vec<Self> {
        let (setup, geometry) = (lattice.setup(), lattice.geometry());
        let asked = [
            ("eddy viscosity", setup.wale.is_some()),
            ("body force", !matches!(setup.force, Force::None)),
            ("blocks", setup.solid_operator.is_some()),
            ("walls", !geometry.mixed.is_empty()),
        ];
        let absent: Vec<&str> = asked
            .iter()
            .filter(|(_, has)| !has)
            .map(|(name, _)| *name)
            .collect();
        let features = asked.len() as f64;
        let run = (geometry.plain.len() + geometry.mixed.len()) as f64;
        let all = run + f64::from(geometry.solid_bricks);
        let kernel = format!(
            "features of the fluid kernel, {} being absent from it",
            absent.join(", ")
        );
        let bricks = "bricks of cells, the others being solid";
        let checked = "bricks with walls to look for, the others being plain";
        [
            Self::some(&kernel, features - absent.len() as f64, features),
            Self::some(bricks, run, all),
            Self::some(checked, geometry.mixed.len() as f64, run),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    /// Which bricks need not know of blocks in a fluid.
    pub fn of_places(coupling: &Coupling) -> Vec<Self> {
        let bricks =
            (coupling.plain_bricks + coupling.mixed_bricks + coupling.saturated_bricks) as f64;
        let saturated = coupling.saturated_bricks as f64;
        let with = "bricks with blocks, the others running the kernel without";
        Self::some(with, saturated, bricks).into_iter().collect()
    }

    /// What blocks in a fluid did without.
    pub fn of_coupling(coupling: &Coupling) -> Vec<Self> {
        let steps = (coupling.readings + coupling.readings_skipped) as f64;
        let (done, tiles) = (
            coupling.tiles_computed as f64,
            steps * coupling.tiles as f64,
        );
        let mut all = Self::of_places(coupling);
        all.extend(Self::some(
            "tiles of blocks computed anew, the others having stood still",
            done,
            tiles,
        ));
        all.extend(Self::some(
            "loads read back, nobody needing the others",
            coupling.readings as f64,
            steps,
        ));
        all
    }

    /// What contacts did without.
    pub fn of_rocks(rocks: &Rocks) -> Vec<Self> {
        let blocks = rocks.blocks as f64;
        let pairs = "pairs looked at each step, the others being far apart";
        let programs =
            "linear programs, the other pairs being decided by what they kept or by their faces";
        [
            Self::some(pairs, rocks.pairs as f64, 0.5 * blocks * (blocks - 1.0)),
            Self::some(programs, rocks.programs as f64, rocks.tests as f64),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    /// What water of particles did without.
    pub fn of_pool(pool: &Pool) -> Vec<Self> {
        let sorts = "sorts, the lists of neighbours serving several steps";
        Self::some(sorts, pool.sorts as f64, pool.steps_here as f64)
            .into_iter()
            .collect()
    }
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let share = 100.0 * self.done / self.of;
        write!(
            f,
            "{:.0} of {:.0} ({share:.2} %) {}",
            self.done, self.of, self.what
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_was_spared_is_told() {
        let mut rocks = Rocks {
            blocks: 10,
            pairs: 45,
            tests: 900,
            programs: 9,
            ..Rocks::default()
        };
        let told = LeftOut::of_rocks(&rocks);
        assert_eq!(told.len(), 1);
        assert!(
            told[0]
                .to_string()
                .starts_with("9 of 900 (1.00 %) linear programs"),
            "{}",
            told[0]
        );
        rocks.pairs = 12;
        assert_eq!(LeftOut::of_rocks(&rocks).len(), 2);
    }
}
