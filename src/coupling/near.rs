//! Cells in and beside blocks, on the host.

use super::Coupled;
use crate::immersed::{NearCell, near, outline};
use glam::DVec3;

/// A cell in or beside a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockCell {
    /// The block.
    pub block: usize,
    /// The cell, with its distance from the nearest part of any block.
    pub near: NearCell,
}

impl Coupled {
    /// The cells whose centres lie at most `reach` cells from a block in the fluid, in the order of the
    /// cells, each with the block that is nearest to it.
    pub fn near(&self, reach: f64) -> Vec<BlockCell> {
        let frame = self.immersed().frame();
        let (cells, periodic) = self.immersed().domain();
        let poses = self.blocks().poses();
        let (mut all, mut found) = (Vec::new(), Vec::new());
        for (block, pose) in poses.iter().enumerate().take(self.in_fluid()) {
            for part in self.setup().setup.blocks[block].shape.parts() {
                let outline = outline(frame, part, pose);
                near(&outline, reach, cells, periodic, &mut found);
            }
            all.extend(found.drain(..).map(|near| BlockCell { block, near }));
        }
        let order = |a: &BlockCell, b: &BlockCell| {
            let cells = a.near.cell.cmp(&b.near.cell);
            cells.then(a.near.distance.total_cmp(&b.near.distance))
        };
        all.sort_by(order);
        all.dedup_by_key(|found| found.near.cell);
        all
    }

    /// Velocity of a block's solid at the place `x` (m), m/s.
    pub fn solid_velocity(&self, block: usize, x: DVec3) -> DVec3 {
        let pose = self.blocks().poses()[block];
        let gradient = pose.deformation_rate * pose.deformation.inverse();
        pose.velocity + gradient * (x - pose.centre)
    }
}
