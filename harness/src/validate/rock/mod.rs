//! Dry blocks that run on the host.

pub mod deformable;
pub mod detection;
pub mod dynamics;
pub mod incline;
pub mod rest;
pub mod submerged;

use super::Trial;
use glam::DVec3;
pub use kit::rock::{DENSITY, joint, setup, slope};
use riprap::{
    geometry::{Polyhedron, Shape},
    rock::{Block, Blocks, EnergyLedger, Setup, broadphase::HostBroadphase},
};
use std::{sync::Arc, time::Instant};

/// Standard gravity, as [`Setup`] has it, m/s².
pub const G: f64 = 9.81;

/// Running blocks, with the wall time spent on them.
#[derive(Debug)]
pub struct Rock {
    /// The blocks.
    pub blocks: Blocks,
    /// Their energies before the first step.
    pub start: EnergyLedger,
    what: String,
    seconds: f64,
}

impl Rock {
    /// Blocks at the start, with a one-line description.
    pub fn new(setup: Setup, what: impl Into<String>) -> anyhow::Result<Self> {
        let blocks = Blocks::new(setup)?;
        Ok(Self {
            start: blocks.ledger(),
            blocks,
            what: what.into(),
            seconds: 0.0,
        })
    }

    /// Blocks that start from the state in which `held`, blocks of the same shapes, settled under the mass damping `damping`
    /// (1/s) in `time` (s), as if set down slowly.
    pub fn from_rest(
        held: Setup,
        damping: f64,
        time: f64,
        setup: Setup,
        what: impl Into<String>,
    ) -> anyhow::Result<Self> {
        let mut before = Self::new(Setup { damping, ..held }, "")?;
        before.run(time)?;
        let mut after = Self::new(setup, what)?;
        after.blocks.restore(&before.blocks.snapshot())?;
        after.start = after.blocks.ledger();
        after.seconds = before.seconds;
        Ok(after)
    }

    /// Runs for `time` s.
    pub fn run(&mut self, time: f64) -> anyhow::Result<()> {
        let begin = Instant::now();
        let until = self.blocks.time() + time;
        pollster::block_on(self.blocks.advance(&mut HostBroadphase, until))?;
        self.seconds += begin.elapsed().as_secs_f64();
        Ok(())
    }

    /// Error of the energy balance since the start, J.
    pub fn energy_error(&self) -> f64 {
        (self.blocks.ledger().balance() - self.start.balance()).abs()
    }

    /// Vertical stress of a deformable block, Pa.
    pub fn vertical_stress(&self, block: usize) -> f64 {
        let stress = self.blocks.stress(block);
        stress.map_or(f64::NAN, |stress| stress.z_axis.z)
    }

    /// Setup and cost of the run so far.
    pub fn trial(&self) -> Trial {
        Trial {
            setup: self.what.clone(),
            cells: self.blocks.len() as u64,
            steps: self.blocks.steps(),
            seconds: self.seconds,
            ..Trial::default()
        }
    }
}

/// A box of these edges, m.
pub fn cuboid(x: f64, y: f64, z: f64) -> anyhow::Result<Arc<Shape>> {
    Ok(Arc::new(Polyhedron::cuboid(DVec3::new(x, y, z))?.into()))
}

/// A fixed floor of this width (m) whose top is at z = 0.
pub fn floor(width: f64) -> anyhow::Result<Block> {
    Ok(Block::new("floor", cuboid(width, width, 1.0)?, DVec3::Z * -0.5).fixed())
}
