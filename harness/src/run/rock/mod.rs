//! The blocks of a run, with or without a fluid around them.

pub mod block_probe;
mod rocks;
mod safety;

pub use rocks::Rocks;
pub use safety::{Factors, Safety};

use riprap::{
    coupling::{Coupled, FluidLoad},
    rock::{Blocks, EnergyLedger, Motion, Setup},
};

/// The present state of the blocks of a run.
#[derive(Clone, Copy)]
pub struct Rock<'a> {
    /// Steps done.
    pub step: u64,
    /// Simulated time, s.
    pub time: f64,
    /// The blocks as set up.
    pub setup: &'a Setup,
    /// The present blocks.
    pub blocks: &'a Blocks,
    /// Loads of the fluid on the blocks in it, which come first; none without a fluid.
    pub loads: &'a [FluidLoad],
    /// The coupling with the fluid, if there is one.
    pub coupled: Option<Coupled<'a>>,
    /// Number of blocks that are shown, the first ones; the blocks that represent faces of the domain are not.
    pub shown: usize,
    /// Energies at the start of the scene, before any restart.
    pub start: &'a EnergyLedger,
}

impl Rock<'_> {
    /// Number of blocks that are neither fixed nor asleep.
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

    /// Number of blocks whose motion is `wanted`.
    pub fn count(&self, wanted: fn(&Motion) -> bool) -> usize {
        let shown = self.setup.blocks[..self.shown].iter();
        shown.filter(|block| wanted(&block.motion)).count()
    }

    /// Numbers of moving blocks and of contacts, in words.
    pub fn activity(&self) -> String {
        format!(
            "{} of {} blocks awake, {} contacts",
            self.awake(),
            self.shown,
            self.blocks.contacts().count()
        )
    }

    /// Numbers of free, driven and fixed blocks, in words.
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
