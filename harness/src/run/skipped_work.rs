//! Work that a run skipped because its scene did not need it: counts, without measurement.

use super::{lattice::Coupling, rock::Rocks, water::WaterSummary};
use riprap::lattice::{Force, Lattice};
use serde::Serialize;
use std::fmt;

/// Work of one kind: how much was done, out of how much a program without this shortcut does.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SkippedWork {
    /// What was skipped, and why.
    pub what: String,
    /// Work done.
    pub done: f64,
    /// Work without the shortcut.
    pub of: f64,
}

impl SkippedWork {
    /// Those of `works` (what, done, of how much) that were not done in full.
    fn some<'a>(works: impl IntoIterator<Item = (&'a str, f64, f64)>) -> Vec<Self> {
        let works = works.into_iter().filter(|(_, done, of)| done < of);
        let left = |(what, done, of): (&str, _, _)| Self {
            what: what.into(),
            done,
            of,
        };
        works.map(left).collect()
    }

    /// Features that the kernels of a lattice omit, and its bricks without water.
    pub fn of_lattice(lattice: &Lattice) -> Vec<Self> {
        let (setup, geometry) = (lattice.setup(), lattice.geometry());
        let features = [
            ("eddy viscosity", setup.wale.is_some()),
            ("body force", !matches!(setup.force, Force::None)),
            ("blocks", setup.solid_operator.is_some()),
            (
                "walls",
                !geometry.mixed.is_empty() || !geometry.surface.is_empty(),
            ),
        ];
        let absent: Vec<&str> = features
            .iter()
            .filter(|(_, has)| !has)
            .map(|(name, _)| *name)
            .collect();
        let of = features.len() as f64;
        let walls = (geometry.mixed.len() + geometry.surface.len()) as f64;
        let run = geometry.plain.len() as f64 + walls;
        let all = run + f64::from(geometry.solid_bricks);
        let absent_count = absent.len() as f64;
        let kernel = format!(
            "features of the fluid kernel, without {}",
            absent.join(", ")
        );
        Self::some([
            (kernel.as_str(), of - absent_count, of),
            ("bricks of cells, the others being solid", run, all),
            ("bricks with walls, the others being plain", walls, run),
        ])
    }

    /// Bricks of a lattice that no block reaches.
    pub fn of_places(coupling: &Coupling) -> Vec<Self> {
        let with = coupling.saturated_bricks;
        let bricks = coupling.plain_bricks + coupling.mixed_bricks + with;
        let what = "bricks with blocks, the others running the kernel without";
        Self::some([(what, with as f64, bricks as f64)])
    }

    /// Work that the coupling of blocks and fluid skipped.
    pub fn of_coupling(coupling: &Coupling) -> Vec<Self> {
        let readings = coupling.readings as f64;
        let steps = (coupling.readings + coupling.readings_skipped) as f64;
        let computed = "tiles of blocks computed anew, the others standing still";
        let tiles = coupling.tiles_computed as f64;
        let mut all = Self::of_places(coupling);
        all.extend(Self::some([
            (computed, tiles, steps * coupling.tiles as f64),
            (
                "loads read back, the others not being needed",
                readings,
                steps,
            ),
        ]));
        all
    }

    /// Work that the contact search skipped.
    pub fn of_rocks(rocks: &Rocks) -> Vec<Self> {
        let (blocks, pairs) = (rocks.blocks as f64, rocks.pairs as f64);
        let far = "candidate pairs, the others being far apart";
        let decided = "linear programs, the other pairs being decided by their caches or faces";
        Self::some([
            (far, pairs, 0.5 * blocks * (blocks - 1.0)),
            (decided, rocks.programs as f64, rocks.tests as f64),
        ])
    }

    /// Work that free water skipped.
    pub fn of_pool(pool: &WaterSummary) -> Vec<Self> {
        let sorts = "sorts, the lists of neighbours serving several steps";
        Self::some([(sorts, pool.sorts as f64, pool.steps_here as f64)])
    }

    /// All of them in one line; `None` if nothing was skipped.
    pub fn line(all: &[Self]) -> Option<String> {
        let texts: Vec<String> = all.iter().map(ToString::to_string).collect();
        (!texts.is_empty()).then(|| texts.join("; "))
    }
}

impl fmt::Display for SkippedWork {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.0} of {:.0} {}", self.done, self.of, self.what)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_was_left_out_is_reported() {
        let mut rocks = Rocks {
            blocks: 10,
            pairs: 45,
            tests: 900,
            programs: 9,
            ..Rocks::default()
        };
        let found = SkippedWork::of_rocks(&rocks);
        assert_eq!(found.len(), 1);
        let text = found[0].to_string();
        assert!(text.starts_with("9 of 900 linear programs"), "{text}");
        rocks.pairs = 12;
        assert_eq!(SkippedWork::of_rocks(&rocks).len(), 2);
        assert_eq!(SkippedWork::line(&[]), None);
    }
}
