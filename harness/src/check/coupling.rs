//! Where blocks and fluid meet, before a run.

use super::{BlockFacts, lines::Lines};
use crate::{print::bytes, run::Coupling};
use riprap::{
    coupling::{Coupled, Gap},
    simulation::Simulation,
};
use serde::Serialize;

/// Gaps that are listed one by one.
const LISTED: usize = 20;

/// What `riprap check` says of blocks in a fluid.
#[derive(Debug, Serialize)]
pub struct Immersion {
    /// The blocks.
    #[serde(flatten)]
    pub facts: BlockFacts,
    /// Where they are in the lattice after the trial.
    pub cells: Coupling,
    /// Steps of the fluid from one exchange to the next.
    pub interval: u32,
    /// Pairs of blocks that are less than a cell apart at the start.
    pub narrow_gaps: usize,
    /// Those of them that touch.
    pub closed_gaps: usize,
    /// Whether lubrication acts in gaps that the grid does not resolve.
    pub lubrication: bool,
    /// The narrowest of them that do not, at most 20.
    pub narrowest: Vec<Narrow>,
}

/// A gap between two blocks.
#[derive(Debug, Serialize)]
pub struct Narrow {
    /// Names of the blocks.
    pub blocks: [String; 2],
    /// m.
    pub width: f64,
    /// The same in cells.
    pub cells: f64,
}

impl Immersion {
    /// Of the blocks in `simulation`, if there are any, after `steps` steps of trial.
    pub fn of(simulation: &Simulation, steps: u64) -> Option<Self> {
        let coupled = simulation.coupled()?;
        let scene = simulation.scene();
        let cell = scene.domain.cell;
        let shown = coupled.in_fluid() + scene.solids.len();
        let setup = coupled.setup();
        let shown = &setup.setup.blocks[..shown];
        let time_step = simulation.time_step();
        let mut open: Vec<&Gap> = coupled.gaps().iter().collect();
        open.retain(|gap| !gap.is_closed(cell));
        open.sort_by(|a, b| a.width.total_cmp(&b.width));
        Some(Self {
            facts: BlockFacts::of(shown, coupled.blocks(), &setup.left_out, time_step),
            cells: Coupling::of(simulation, steps)?,
            interval: scene.coupling.interval,
            narrow_gaps: coupled.gaps().len(),
            lubrication: setup.setup.film.is_some(),
            closed_gaps: coupled.gaps().len() - open.len(),
            narrowest: open
                .iter()
                .take(LISTED)
                .map(|gap| Narrow::of(&coupled, gap, cell))
                .collect(),
        })
    }

    /// Lines of a name and what there is of it.
    pub fn lines(&self, lines: &mut Lines) {
        self.facts.lines(lines);
        lines.add(
            "in the fluid",
            format_args!("{} blocks: {}", self.cells.in_fluid, self.cells.kinds()),
        );
        lines.add(
            "",
            format_args!(
                "{} on the device; they meet the fluid every {} steps",
                bytes(self.cells.bytes),
                self.interval
            ),
        );
        lines.add(
            "gaps",
            format_args!(
                "{} pairs closer than a cell, {} of them touch; {} lubrication",
                self.narrow_gaps,
                self.closed_gaps,
                if self.lubrication { "with" } else { "without" }
            ),
        );
        for gap in &self.narrowest {
            let [a, b] = &gap.blocks;
            let Narrow { width, cells, .. } = gap;
            lines.add(
                "",
                format_args!("{a} and {b}: {width:.3e} m, {cells:.2} cells"),
            );
        }
    }
}

impl Narrow {
    fn of(coupled: &Coupled<'_>, gap: &Gap, cell: f64) -> Self {
        Self {
            blocks: gap.blocks.map(|block| coupled.blocks().name(block).into()),
            width: gap.width,
            cells: gap.width / cell,
        }
    }
}
