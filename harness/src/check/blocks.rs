//! The blocks of a scene, with or without a fluid around them.

use super::lines::Lines;
use crate::{broadphase::left_out, print::bytes, run::Coupling};
use riprap::{
    coupling::{Coupled, Gap},
    geometry::{Form, Shape},
    rock::{Block, Blocks, Motion},
    scene::build::DiscardedPieces,
    simulation::Simulation,
};
use serde::Serialize;
use std::{collections::HashMap, sync::Arc};

/// What `riprap check` reports on blocks.
#[derive(Debug, Serialize)]
pub struct BlockFacts {
    /// Blocks in all, solids included.
    pub blocks: usize,
    /// Blocks moved by forces.
    pub free: usize,
    /// Blocks moved by formulas.
    pub driven: usize,
    /// Blocks that do not move.
    pub fixed: usize,
    /// Different shapes.
    pub shapes: usize,
    /// Convex parts of all blocks.
    pub parts: usize,
    /// Parts that are spheres.
    pub spheres: usize,
    /// Faces of the other parts.
    pub faces: usize,
    /// Pieces of rock masses that are too small for a block, one line per mass.
    pub left_out: Vec<String>,
    /// Mass of the free blocks, kg.
    pub mass: f64,
    /// Lightest free block: its name and mass, kg.
    pub lightest: Option<(String, f64)>,
    /// Pairs of parts that may touch after the trial.
    pub pairs: usize,
    /// Contacts after the trial.
    pub contacts: usize,
    /// Distance at which parts are candidates, m.
    pub skin: f64,
    /// Longest sub-step after the trial, s.
    pub sub_step: f64,
    /// Sub-steps per step.
    pub sub_steps: u64,
    /// Approximate bytes of the blocks' state and shapes on the host.
    pub host_memory: u64,
}

impl BlockFacts {
    /// The facts of `blocks`, the first of which are `shown`, with steps of `time_step` s.
    pub fn of(shown: &[Block], blocks: &Blocks, left: &[DiscardedPieces], time_step: f64) -> Self {
        let count = |wanted: fn(&Motion) -> bool| {
            let motions = shown.iter().map(|block| &block.motion);
            motions.filter(|motion| wanted(motion)).count()
        };
        let shapes: HashMap<*const Shape, &Shape> = shown
            .iter()
            .map(|block| (Arc::as_ptr(&block.shape), &*block.shape))
            .collect();
        let parts = || shown.iter().flat_map(|block| block.shape.parts());
        let faces = |form: &Form| match form {
            Form::Convex(shape) => shape.faces().len(),
            Form::Sphere { .. } => 0,
        };
        let free: Vec<usize> = (0..shown.len())
            .filter(|block| shown[*block].motion == Motion::Free)
            .collect();
        let mass = |block: &usize| blocks.mass(*block);
        let lightest = free.iter().min_by(|a, b| mass(a).total_cmp(&mass(b)));
        let sub_steps = (time_step / blocks.time_step() * (1.0 - 1e-12)).ceil();
        Self {
            blocks: shown.len(),
            free: free.len(),
            driven: count(|motion| matches!(motion, Motion::Driven { .. })),
            fixed: count(|motion| *motion == Motion::Fixed),
            shapes: shapes.len(),
            parts: parts().count(),
            spheres: parts()
                .filter(|part| matches!(part.form, Form::Sphere { .. }))
                .count(),
            faces: parts().map(|part| faces(&part.form)).sum(),
            left_out: left_out(left).collect(),
            mass: free.iter().map(mass).fold(0.0, |sum, mass| sum + mass),
            lightest: lightest.map(|block| (blocks.name(*block).into(), mass(block))),
            pairs: blocks.candidate_pair_count(),
            contacts: blocks.contacts().count(),
            skin: blocks.skin(),
            sub_step: blocks.time_step().min(time_step),
            sub_steps: sub_steps.max(1.0) as u64,
            host_memory: blocks.snapshot().bytes()
                + shapes.values().map(|shape| size(shape)).sum::<u64>(),
        }
    }

    /// Adds one line per item, with its name and value.
    pub fn lines(&self, lines: &mut Lines) {
        lines.add(
            "blocks",
            format_args!(
                "{}: {} free, {} driven, {} fixed",
                self.blocks, self.free, self.driven, self.fixed
            ),
        );
        lines.add(
            "shapes",
            format_args!(
                "{} different ones; {} convex parts, {} of them spheres; {} faces",
                self.shapes, self.parts, self.spheres, self.faces
            ),
        );
        for left_out in &self.left_out {
            lines.add("left out", left_out);
        }
        let lightest = self.lightest.as_ref();
        lines.add(
            "mass",
            format_args!(
                "{:.4e} kg free{}",
                self.mass,
                lightest.map_or(String::new(), |(name, mass)| format!(
                    "; the lightest is {name} with {mass:.3e} kg"
                ))
            ),
        );
        lines.add(
            "contacts",
            format_args!(
                "{} in {} pairs within {:.3e} m",
                self.contacts, self.pairs, self.skin
            ),
        );
        lines.add(
            "sub-steps",
            format_args!(
                "{} of at most {:.4e} s per step",
                self.sub_steps, self.sub_step
            ),
        );
        lines.add("on the host", bytes(self.host_memory));
    }
}

/// Number of gaps that are listed one by one.
const LISTED: usize = 20;

/// What `riprap check` reports on blocks in a fluid.
#[derive(Debug, Serialize)]
pub struct Immersion {
    /// The blocks.
    #[serde(flatten)]
    pub facts: BlockFacts,
    /// Their tiles and bricks in the lattice after the trial.
    pub cells: Coupling,
    /// Steps of the fluid from one exchange to the next.
    pub interval: u32,
    /// Pairs of blocks that are less than a cell apart at the start.
    pub narrow_gaps: usize,
    /// Pairs of them that touch.
    pub closed_gaps: usize,
    /// Whether lubrication acts in gaps that the grid does not resolve.
    pub lubrication: bool,
    /// The narrowest pairs that do not touch, at most 20.
    pub narrowest: Vec<Narrow>,
    /// Water in closed joints.
    pub closed_joints: ClosedJoints,
}

/// Hydraulic properties of closed joints, for faces between rows of cells and within one row.
#[derive(Debug, Serialize)]
pub struct ClosedJoints {
    /// Hydraulic apertures by the cubic law, narrowest and widest, m.
    pub apertures: [f64; 2],
    /// Side of a cube with the volume of the largest block, taken as the side of a square face, m.
    pub face: f64,
    /// Time until half of a pressure change around such a face has reached its middle, shortest and longest, s.
    pub times: [f64; 2],
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
    /// The blocks in `simulation`, if there are any, after `steps` steps of trial.
    pub fn of(simulation: &Simulation, steps: u64) -> Option<Self> {
        let coupled = simulation.coupled()?;
        let scene = simulation.scene();
        let cell = scene.domain.cell;
        let shown = coupled.in_fluid() + scene.solids.len();
        let setup = coupled.setup();
        let (shown, wet) = (
            &setup.setup.blocks[..shown],
            &setup.setup.blocks[..coupled.in_fluid()],
        );
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
            closed_joints: ClosedJoints::of(simulation, wet)?,
        })
    }

    /// Adds one line per item, with its name and value.
    pub fn lines(&self, lines: &mut Lines) {
        self.facts.lines(lines);
        lines.add(
            "in the fluid",
            format_args!("{} blocks: {}", self.cells.in_fluid, self.cells.kinds()),
        );
        lines.add(
            "",
            format_args!(
                "{} on the device; they exchange with the fluid every {} steps",
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
        if self.closed_gaps == 0 {
            return;
        }
        let ClosedJoints {
            apertures,
            face,
            times,
        } = &self.closed_joints;
        lines.add(
            "joints",
            format_args!(
                "closed ones let water through as slots of {} m; the pressure in the middle of a face of {face:.3} m follows half of a change around it after {} s",
                range(*apertures),
                range(*times)
            ),
        );
    }
}

/// One number, or two if they differ.
fn range([low, high]: [f64; 2]) -> String {
    let [low, high] = [low, high].map(|number| format!("{number:.2e}"));
    match low == high {
        true => low,
        false => format!("{low} to {high}"),
    }
}

/// Time until half of a pressure change at the four sides of a square has reached its middle, in units of the square of the
/// side over the diffusivity.
const HALF_TIME: f64 = 0.0594;

impl ClosedJoints {
    fn of(simulation: &Simulation, blocks: &[Block]) -> Option<Self> {
        let (setup, units) = (simulation.lattice()?.setup(), simulation.units()?);
        let volumes = blocks.iter().map(|block| block.shape.volume());
        let face = volumes.fold(0.0, f64::max).cbrt();
        let cells = (face / units.cell).powi(2);
        let sorted = |[a, b]: [f64; 2]| [a.min(b), a.max(b)];
        let time = |diffusivity| units.time_from_lattice(HALF_TIME * cells / diffusivity);
        Some(Self {
            apertures: sorted(setup.joint_apertures().map(|a| a * units.cell)),
            face,
            times: sorted(setup.joint_diffusivities().map(time)),
        })
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

/// Bytes of a shape's faces, corners, edges and rings.
fn size(shape: &Shape) -> u64 {
    let parts = shape.parts().iter().map(|part| match &part.form {
        Form::Convex(block) => {
            let corners: usize = block.loops().iter().map(Vec::len).sum();
            size_of_val(block.faces())
                + size_of_val(block.vertices())
                + size_of_val(block.edges())
                + size_of_val(block.loops())
                + 4 * corners
        }
        Form::Sphere { .. } => 0,
    });
    parts.map(|bytes| bytes as u64).sum()
}

#[cfg(test)]
mod tests {
    use super::HALF_TIME;
    use std::f64::consts::PI;

    /// The deficit in the middle of a square is the square of the deficit in the middle of a strip.
    #[test]
    fn half_of_a_change_is_in_the_middle_of_a_square() {
        let missing = |n: f64| {
            let odd = 2.0 * n + 1.0;
            let sign = if n % 2.0 == 0.0 { 1.0 } else { -1.0 };
            sign * 4.0 / (PI * odd) * (-(odd * PI).powi(2) * HALF_TIME).exp()
        };
        let strip: f64 = (0..50).map(|n| missing(f64::from(n))).sum();
        assert!((strip * strip - 0.5).abs() < 2e-3, "{strip}");
    }
}
