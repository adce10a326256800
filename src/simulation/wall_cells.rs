//! The first cells next to walls, solids and blocks.

use super::lattice_fluid::LatticeFluid;
use crate::{coupling::Coupled, lattice::Face};
use glam::DVec3;

/// A fluid cell next to a wall, a solid or a block.
pub(super) struct WallCell {
    /// Its place in an array over the domain, x fastest.
    pub cell: u32,
    /// Unit normal of the wall.
    pub normal: DVec3,
    /// Distance of the cell's centre from the wall, cells.
    pub distance: f64,
    /// Velocity of the wall, m/s.
    pub wall_velocity: DVec3,
    /// The block, if it is one.
    pub block: Option<usize>,
}

impl LatticeFluid {
    /// All of them; a cell next to two walls is there for each, but only once for all blocks.
    pub(super) fn wall_cells(&self, coupled: Option<Coupled<'_>>) -> Vec<WallCell> {
        let near = coupled.map(|coupled| coupled.cells_near_blocks(1.5));
        let near = near.unwrap_or_default();
        // Where a block is close, its cells are those of the block.
        let taken: Vec<u32> = near.iter().map(|found| found.cell.index).collect();
        let mut all = self.cells_at_walls();
        all.retain(|wall_cell| taken.binary_search(&wall_cell.cell).is_err());
        let solid = self.solid();
        for found in &near {
            let (at, distance) = (found.cell.index, found.cell.distance);
            if distance < 0.5 || solid.get(at as usize).is_some_and(|solid| *solid) {
                continue;
            }
            let centre = self.centre_of(at);
            let velocity = coupled.map(|coupled| coupled.solid_velocity(found.block, centre));
            all.push(WallCell {
                cell: at,
                normal: found.cell.normal,
                distance,
                wall_velocity: velocity.unwrap_or_default(),
                block: Some(found.block),
            });
        }
        all
    }

    /// Those next to faces of the domain that are walls, and next to solids.
    fn cells_at_walls(&self) -> Vec<WallCell> {
        let setup = self.lattice.setup();
        let counts = setup.cells.map(|n| n as usize);
        let solid = |at: usize| setup.solid.get(at).is_some_and(|solid| *solid);
        let mut all = Vec::new();
        let mut stride = 1;
        for axis in 0..3 {
            let n = counts[axis];
            for side in 0..2 {
                let face = &setup.faces[axis][side];
                let mut normal = DVec3::ZERO;
                normal[axis] = if side == 0 { 1.0 } else { -1.0 };
                let end = if side == 0 { 0 } else { n - 1 };
                for at in 0..counts.iter().product() {
                    let at_end = at / stride % n == end;
                    if solid(at) || (!at_end && setup.solid.is_empty()) {
                        continue;
                    }
                    let next = match (side, at_end) {
                        (0, false) => at - stride,
                        (_, false) => at + stride,
                        (0, true) => at + (n - 1) * stride,
                        (_, true) => at - (n - 1) * stride,
                    };
                    let wall = match face {
                        Face::Wall(velocity) if at_end => {
                            Some(velocity.map(|v| self.units.velocity_from_lattice(v)))
                        }
                        _ if at_end && *face != Face::Periodic => None,
                        _ => solid(next).then_some([0.0; 3]),
                    };
                    all.extend(wall.map(|velocity| WallCell {
                        cell: at as u32,
                        normal,
                        distance: 0.5,
                        wall_velocity: velocity.into(),
                        block: None,
                    }));
                }
            }
            stride *= n;
        }
        all
    }

    /// Centre of a cell of an array over the domain, m.
    pub(super) fn centre_of(&self, cell: u32) -> DVec3 {
        let [nx, ny, _] = self.lattice.setup().cells;
        let at = [cell % nx, cell / nx % ny, cell / (nx * ny)];
        self.scene.centre(at).into()
    }
}
