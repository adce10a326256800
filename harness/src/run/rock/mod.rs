//! The blocks of a run, with or without a fluid around them.

mod block_files;
mod block_probe;
mod face_table;
mod forces;
mod rocks;
mod safety;
mod values;

pub use block_files::BlockFiles;
use block_probe::BlockProbe;
use face_table::FaceTable;
pub use rocks::Rocks;
pub use safety::{Factors, Safety};
pub use values::values;

use super::{recorder::Recorders, scene_run::SceneRun};
use anyhow::Result;
use riprap::{
    coupling::{Coupled, FluidLoad},
    rock::{Blocks, EnergyLedger, Motion, Setup},
    scene::Probe,
};
use std::path::Path;

/// The blocks of a run as they are now.
#[derive(Clone, Copy)]
pub struct Rock<'a> {
    /// Steps done.
    pub step: u64,
    /// Simulated time, s.
    pub time: f64,
    /// The blocks as they were made.
    pub setup: &'a Setup,
    /// The blocks as they are.
    pub blocks: &'a Blocks,
    /// Those that a fluid flows around, the first ones, with what they feel of it; none without a fluid.
    pub loads: &'a [FluidLoad],
    /// They and the fluid together, where there is one.
    pub coupled: Option<Coupled<'a>>,
    /// Number of blocks that are shown, the first ones: the faces of a domain that hold blocks are none.
    pub shown: usize,
    /// Energies at the start, those that a restart has not seen included.
    pub start: &'a EnergyLedger,
}

/// What writes the tables of a probe of the block called `name`.
pub fn probes(
    run: &SceneRun,
    folder: &Path,
    last: u64,
    (probe, name): (&Probe, &str),
    [faces, safety]: [bool; 2],
) -> Result<Recorders> {
    let named = (probe, name);
    let block = BlockProbe::new(run, folder, last, named, [faces, safety])?;
    let mut recorders: Recorders = vec![Box::new(block)];
    if faces {
        let (_, block) = block_probe::find(run, probe, name)?;
        recorders.push(Box::new(FaceTable::new(run, folder, last, (probe, block))?));
    }
    Ok(recorders)
}

impl Rock<'_> {
    /// Blocks that move or might.
    pub fn awake(&self) -> usize {
        let all = self.blocks.asleep().enumerate();
        all.filter(|(block, asleep)| !asleep && self.blocks.moves(*block))
            .count()
    }

    /// Largest speed of a centroid, m/s.
    pub fn max_speed(&self) -> f64 {
        let poses = self.blocks.poses();
        poses
            .iter()
            .map(|pose| pose.velocity.length())
            .fold(0.0, f64::max)
    }

    /// Number of blocks whose motion is one of those `wanted`.
    pub fn count(&self, wanted: fn(&Motion) -> bool) -> usize {
        let shown = self.setup.blocks[..self.shown].iter();
        shown.filter(|block| wanted(&block.motion)).count()
    }

    /// How much moves and touches, in words.
    pub fn activity(&self) -> String {
        format!(
            "{} of {} blocks awake, {} contacts",
            self.awake(),
            self.shown,
            self.blocks.contacts().count()
        )
    }

    /// Free, driven and fixed blocks, in words.
    pub fn counted(&self) -> String {
        let parts = self.setup.blocks[..self.shown].iter();
        let parts: usize = parts.map(|block| block.shape.parts().len()).sum();
        let soft = (0..self.shown).filter(|&block| self.blocks.stress(block).is_some());
        let soft = match soft.count() {
            0 => String::new(),
            count => format!("; {count} deformable"),
        };
        format!(
            "{}: {} free, {} driven, {} fixed{soft}; {parts} parts",
            self.shown,
            self.count(|motion| *motion == Motion::Free),
            self.count(|motion| matches!(motion, Motion::Driven { .. })),
            self.count(|motion| *motion == Motion::Fixed),
        )
    }
}
