//! The cells inside and near blocks, on the host.

use super::Coupled;
use crate::lattice::State;
use crate::psm::{NearCell, imaged, near_cells, outline};
use crate::scene::Domain;
use glam::DVec3;

/// A cell inside or near a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockCell {
    /// The block.
    pub block: usize,
    /// The cell, with its distance from the nearest part of any block.
    pub cell: NearCell,
}

impl Coupled<'_> {
    /// The cells whose centres lie at most `reach` cells from a block in the fluid, in the order of the
    /// cells, each with its nearest block.
    pub fn cells_near_blocks(&self, reach: f64) -> Vec<BlockCell> {
        let frame = self.solid_cells().frame();
        let (cells, periodic) = self.solid_cells().domain();
        let poses = self.blocks().poses();
        let (mut all, mut found) = (Vec::new(), Vec::new());
        for (block, pose) in poses.iter().enumerate().take(self.in_fluid()) {
            let parts = self.setup().setup.blocks[block].shape.parts().iter();
            let outlines: Vec<_> = parts.map(|part| outline(frame, part, pose)).collect();
            let imaged = imaged(&outlines, cells, periodic);
            for outline in &outlines {
                near_cells(outline, reach, cells, imaged, &mut found);
            }
            all.extend(found.drain(..).map(|cell| BlockCell { block, cell }));
        }
        let order = |a: &BlockCell, b: &BlockCell| {
            let indices = a.cell.index.cmp(&b.cell.index);
            indices.then(a.cell.distance.total_cmp(&b.cell.distance))
        };
        all.sort_by(order);
        all.dedup_by_key(|found| found.cell.index);
        all
    }

    /// Velocity of a block's solid at the place `x` (m) or at its periodic image nearest to the block, m/s.
    pub fn solid_velocity(&self, block: usize, x: DVec3) -> DVec3 {
        let pose = self.rock.poses()[block];
        let gradient = pose.deformation_rate * pose.deformation.inverse();
        let (cells, periodic) = self.solid_cells().domain();
        let mut r = x - pose.centre;
        for axis in (0..3).filter(|&axis| periodic[axis]) {
            let period = f64::from(cells[axis]) * self.solid_cells().frame().units.cell;
            r[axis] -= period * (r[axis] / period).round();
        }
        pose.velocity + gradient * r
    }

    /// Sets the velocity of the fluid inside the blocks to that of the blocks. Otherwise the acceleration of the fluid
    /// to their velocity would take momentum from them.
    pub fn set_interior_velocity(&self, domain: &Domain, state: &mut State) {
        let units = self.solid_cells().frame().units;
        let cells = domain.cells();
        for found in self.cells_near_blocks(0.0) {
            let at = found.cell.index;
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
