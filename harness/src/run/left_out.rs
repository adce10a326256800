//! What a run did not do because its scene did not need it.

use super::{flow::Coupling, rock::Rocks, water::WaterSummary};
use crate::print::percent;
use riprap::lattice::{Force, Lattice, bytes_a_step};
use serde::Serialize;
use std::{collections::BTreeSet, fmt};

/// Buffers that the kernels of a step may have beside the populations.
const BINDINGS: [&str; 7] = [
    "bricks",
    "flags",
    "force_field",
    "guard_state",
    "psm_planes",
    "velocity_after",
    "velocity_before",
];
/// Bytes of a cell that eddy viscosity moves: a velocity in and one out.
const VELOCITIES: f64 = 24.0;
/// Bytes of the flags of an element, or of the place of a brick in its list.
const WORD: f64 = 4.0;

/// Work of one kind: how much of it was done, of how much that a program without this shortcut does.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeftOut {
    /// What was left out, and why.
    pub what: String,
    /// What was done.
    pub done: f64,
    /// Of how much.
    pub of: f64,
    /// An estimate of the time that this saved, as a part of what a step took: the count of what was left out times what
    /// one of it cost in this run. None where this run does not tell what one costs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub saves: Option<f64>,
}

impl LeftOut {
    /// Nothing if nothing was spared.
    fn some(what: &str, done: f64, of: f64) -> Option<Self> {
        let what = what.to_owned();
        let saves = None;
        (done < of).then_some(Self {
            what,
            done,
            of,
            saves,
        })
    }

    /// The same with an estimate of what it saved, in steps.
    fn saving(what: &str, done: f64, of: f64, saves: f64) -> Option<Self> {
        let saves = (saves.is_finite() && saves > 0.0).then_some(saves);
        Self::some(what, done, of).map(|left| Self { saves, ..left })
    }

    /// What the kernels of a lattice do without, and its bricks without water: before any step. What it saves is
    /// estimated by bytes, each of which is taken to cost what one of this step does.
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
        let bound: BTreeSet<&str> = lattice
            .kernels(false)
            .flat_map(|(kernel, _)| kernel.bindings())
            .map(|binding| binding.name.as_str())
            .collect();
        let unbound = BINDINGS.iter().copied();
        let unbound: Vec<&str> = unbound.filter(|name| !bound.contains(name)).collect();
        let bindings = format!(
            "bindings of a step beside its populations, without {}",
            unbound.join(", ")
        );
        let has = (BINDINGS.len() - unbound.len()) as f64;
        let bricks = "bricks of cells, the others being solid";
        let checked = "bricks with walls to look for, the others being plain";
        let step = bytes_a_step(setup, lattice.grid(), geometry) as f64;
        let velocities = match setup.wale {
            None => VELOCITIES * geometry.fluid_cells as f64 / step,
            Some(_) => 0.0,
        };
        let elements: f64 = lattice.grid().brick.iter().map(|n| f64::from(*n)).product();
        let flags = match setup.is_all_fluid() {
            // Neither flags nor a list of bricks.
            true => WORD * (elements + 1.0) * run / step,
            false => WORD * elements * geometry.plain.len() as f64 / step,
        };
        [
            Self::saving(
                &kernel,
                features - absent.len() as f64,
                features,
                velocities,
            ),
            Self::some(&bindings, has, BINDINGS.len() as f64),
            Self::saving(bricks, run, all, (all - run) / run),
            Self::saving(checked, geometry.mixed.len() as f64, run, flags),
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
        let saves = (bricks - saturated) * coupling.brick_share;
        Self::saving(with, saturated, bricks, saves)
            .into_iter()
            .collect()
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
        let skipped = coupling.readings_skipped as f64 / steps;
        all.extend(Self::saving(
            "loads read back, nobody needing the others",
            coupling.readings as f64,
            steps,
            skipped * coupling.reading_seconds / coupling.step_seconds,
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
            Self::saving(
                programs,
                rocks.programs as f64,
                rocks.tests as f64,
                (rocks.tests - rocks.programs) as f64 * rocks.program_seconds / rocks.seconds,
            ),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    /// What water of particles did without.
    pub fn of_pool(pool: &WaterSummary) -> Vec<Self> {
        let sorts = "sorts, the lists of neighbours serving several steps";
        Self::some(sorts, pool.sorts as f64, pool.steps_here as f64)
            .into_iter()
            .collect()
    }
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let share = 100.0 * self.done / self.of;
        match self.done {
            0.0 => write!(f, "none of {:.0} {}", self.of, self.what)?,
            done => write!(
                f,
                "only {done:.0} of {:.0} ({share:.2} %) {}",
                self.of, self.what
            )?,
        }
        match self.saves {
            Some(saves) if saves > 2.0 => {
                write!(f, "; saves an estimated {saves:.0} times what a step takes")
            }
            Some(saves) => write!(f, "; saves an estimated {} of a step", percent(saves)),
            None => Ok(()),
        }
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
                .starts_with("only 9 of 900 (1.00 %) linear programs"),
            "{}",
            told[0]
        );
        rocks.pairs = 12;
        assert_eq!(LeftOut::of_rocks(&rocks).len(), 2);
    }

    #[test]
    fn savings_are_counts_times_what_one_costs() {
        let rocks = Rocks {
            blocks: 2,
            pairs: 1,
            tests: 1000,
            programs: 100,
            program_seconds: 2e-5,
            seconds: 0.1,
            ..Rocks::default()
        };
        // 900 programs of 20 µs in a run of 0.1 s.
        let told = LeftOut::of_rocks(&rocks);
        assert!((told[0].saves.unwrap() - 0.18).abs() < 1e-12);
        assert!(told[0].to_string().ends_with("an estimated 18 % of a step"));
        let coupling = Coupling {
            readings: 10,
            readings_skipped: 30,
            reading_seconds: 1e-3,
            step_seconds: 5e-3,
            saturated_bricks: 4,
            plain_bricks: 16,
            brick_share: 1e-3,
            ..Coupling::default()
        };
        let told = LeftOut::of_coupling(&coupling);
        let saves: Vec<f64> = told.iter().filter_map(|left| left.saves).collect();
        // Sixteen bricks of a thousandth; three of four steps without a fifth of one.
        assert_eq!(saves.len(), 2, "{told:?}");
        assert!((saves[0] - 0.016).abs() < 1e-12 && (saves[1] - 0.15).abs() < 1e-12);
        // What was not measured has no estimate.
        let unknown = LeftOut::of_coupling(&Coupling {
            reading_seconds: 0.0,
            brick_share: 0.0,
            ..coupling
        });
        assert!(unknown.iter().all(|left| left.saves.is_none()));
    }
}
