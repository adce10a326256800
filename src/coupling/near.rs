//! Cells in and beside blocks, on the host.

use super::Coupled;
use crate::immersed::{NearCell, imaged, near, outline};
use crate::lattice::State;
use crate::scene::Domain;
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
            let parts = self.setup().setup.blocks[block].shape.parts().iter();
            let outlines: Vec<_> = parts.map(|part| outline(frame, part, pose)).collect();
            let imaged = imaged(&outlines, cells, periodic);
            for outline in &outlines {
                near(outline, reach, cells, imaged, &mut found);
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

    /// Velocity of a block's solid at the place `x` (m) or its image next to the block, m/s.
    pub fn solid_velocity(&self, block: usize, x: DVec3) -> DVec3 {
        let pose = self.rock.poses()[block];
        let gradient = pose.deformation_rate * pose.deformation.inverse();
        let (cells, periodic) = self.immersed().domain();
        let mut r = x - pose.centre;
        for axis in (0..3).filter(|&axis| periodic[axis]) {
            let period = f64::from(cells[axis]) * self.immersed().frame().units.cell;
            r[axis] -= period * (r[axis] / period).round();
        }
        pose.velocity + gradient * r
    }

    /// Has the fluid inside the blocks move as they do: it is part of them, and what would bring it up to their
    /// speed would be taken from them.
    pub fn fill(&self, domain: &Domain, state: &mut State) {
        let units = self.immersed().frame().units;
        let cells = domain.cells();
        for found in self.near(0.0) {
            let at = found.near.cell;
            let ijk = [
                at % cells[0],
                at / cells[0] % cells[1],
                at / (cells[0] * cells[1]),
            ];
            let centre = DVec3::from(domain.centre(ijk));
            let velocity = self.solid_velocity(found.block, centre).to_array();
            for (field, velocity) in state.velocity.iter_mut().zip(velocity) {
                field[at as usize] = units.velocity_to_lattice(velocity) as f32;
            }
        }
    }
}
