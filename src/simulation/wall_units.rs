//! How well the grid resolves the shear at walls and blocks.
//!
//! Walls and blocks are no-slip boundaries. Without a [wall model](crate::lattice::WallModel), the wall shear stress is the
//! one that the adjacent cells resolve. The centre of the first cell lies y = ½ Δx from a wall; in wall
//! units y⁺ = u_τ y/ν with the friction velocity u_τ = √(τ_w/ρ). Here τ_w follows from the linear profile of
//! the viscous sublayer, u⁺ = y⁺ (Pope 2000, section 7.1.4), with the velocity u along the wall at the
//! first centre: u_τ = √(ν u/y).
//!
//! Up to y⁺ ≈ 5 this profile holds and the estimate is correct. Above, the first cell lies outside the
//! sublayer: the estimate is a lower bound, since u⁺ < y⁺ there, friction at walls is too small, and
//! the position of separation from a smooth surface is uncertain. Pressure depends on y⁺ only weakly, and so does the
//! drag of bodies with edges at which the flow separates anyway.

use super::{Simulation, lattice_fluid::LatticeFluid};
use crate::{
    Result,
    coupling::Coupled,
    lattice::{BlockFace, Face},
    scene::Field,
};
use glam::DVec3;
use std::collections::HashSet;

/// Above this y⁺ the viscous sublayer lies within the first cell.
pub const SUBLAYER: f64 = 5.0;

/// The cell with the largest y⁺.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstCell {
    /// y⁺ half a cell from the wall.
    pub y_plus: f64,
    /// Friction velocity u_τ, m/s.
    pub friction_velocity: f64,
    /// Centre of the cell, m.
    pub position: [f64; 3],
    /// The block next to it; `None` for a wall or a solid.
    pub block: Option<usize>,
}

/// The cells with the largest y⁺ next to walls, solids and blocks without a wall model.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WallUnits {
    /// Next to walls and solids; `None` without these.
    pub walls: Option<FirstCell>,
    /// Next to blocks; `None` without blocks.
    pub blocks: Option<FirstCell>,
}

impl Simulation {
    /// Estimates y⁺ at all walls, solids and blocks without a wall model from the present velocity. Blocks cut through
    /// cells: next to them the estimate uses the cells whose centres are ½ to 3/2 Δx away, and the profile up to the
    /// distance of these centres.
    ///
    /// # Errors
    /// If the scene has no fluid on a lattice, or the device is lost.
    pub async fn wall_units(&mut self) -> Result<WallUnits> {
        let fluid = self.lattice_fluid()?;
        let with_law = fluid.cells_before_block_faces().await?;
        let wall_cells = fluid.wall_cells(self.coupled(), &with_law);
        let cells: Vec<u32> = wall_cells.iter().map(|wall_cell| wall_cell.cell).collect();
        if cells.is_empty() {
            return Ok(WallUnits::default());
        }
        let arrays = self.read(&[Field::Velocity], &cells).await?;
        let values = arrays.iter().flat_map(|array| array.values.chunks_exact(3));
        let mut found = WallUnits::default();
        for (wall_cell, velocity) in wall_cells.iter().zip(values) {
            let velocity = DVec3::from_array([0, 1, 2].map(|a| f64::from(velocity[a])));
            let cell = self.lattice_fluid()?.first_cell(wall_cell, velocity);
            let place = match wall_cell.block {
                None => &mut found.walls,
                Some(_) => &mut found.blocks,
            };
            if place.is_none_or(|largest| cell.y_plus > largest.y_plus) {
                *place = Some(cell);
            }
        }
        Ok(found)
    }
}

impl LatticeFluid {
    fn first_cell(&self, wall_cell: &WallCell, velocity: DVec3) -> FirstCell {
        let cell = self.units.cell;
        let nu = self.scene.fluid.viscosity;
        let slip = velocity - wall_cell.wall_velocity;
        let along = slip.reject_from_normalized(wall_cell.normal).length();
        let friction_velocity = (nu * along / (wall_cell.distance * cell)).sqrt();
        FirstCell {
            y_plus: friction_velocity * 0.5 * cell / nu,
            friction_velocity,
            position: self.centre_of(wall_cell.cell).to_array(),
            block: wall_cell.block,
        }
    }

    /// The first two cells in front of each block face with a wall model, as indices into an array over the domain.
    async fn cells_before_block_faces(&self) -> Result<HashSet<u32>> {
        let (lattice, grid) = (&self.lattice, self.lattice.grid());
        let found = lattice.block_faces(&self.device, &self.queue).await?;
        let before = |face: &BlockFace| {
            let mut out = [0; 3];
            out[face.face as usize / 2] = [-1, 1][face.face as usize % 2];
            let first = grid.neighbour(grid.padded_cell(face.cell), out);
            [first, grid.neighbour(first, out)].map(|cell| grid.index(cell) as u32)
        };
        Ok(found.faces.iter().flat_map(before).collect())
    }

    /// The cells next to walls, solids and blocks without a wall model; `with_law` are the cells to leave out next to
    /// blocks. A cell next to two walls appears once for each wall, but only once for all blocks.
    fn wall_cells(&self, coupled: Option<Coupled<'_>>, with_law: &HashSet<u32>) -> Vec<WallCell> {
        let near = coupled.map(|coupled| coupled.cells_near_blocks(1.5));
        let near = near.unwrap_or_default();
        // Cells near a block are cells of the block, not of a wall.
        let taken: Vec<u32> = near.iter().map(|found| found.cell.index).collect();
        let mut all = self.cells_at_walls();
        all.retain(|wall_cell| taken.binary_search(&wall_cell.cell).is_err());
        let solid = self.solid();
        for found in &near {
            let (at, distance) = (found.cell.index, found.cell.distance);
            let is_solid = solid.get(at as usize).is_some_and(|solid| *solid);
            if distance < 0.5 || is_solid || with_law.contains(&at) {
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

    /// The cells without a wall model next to walls of the domain and to solids.
    fn cells_at_walls(&self) -> Vec<WallCell> {
        let setup = self.lattice.setup();
        let counts = setup.cells.map(|n| n as usize);
        let solid = |at: usize| setup.solid.get(at).is_some_and(|solid| *solid);
        let grid = self.lattice.grid();
        let walls = self.lattice.geometry().walls.cells.iter();
        let mut modelled: HashSet<usize> = walls
            .map(|wall| grid.index(grid.padded_cell(wall.cell)))
            .collect();
        modelled.extend(self.lattice.geometry().surface_faces.open_cells(grid));
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
                    if solid(at) || modelled.contains(&at) || (!at_end && setup.solid.is_empty()) {
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
    fn centre_of(&self, cell: u32) -> DVec3 {
        let [nx, ny, _] = self.lattice.setup().cells;
        let at = [cell % nx, cell / nx % ny, cell / (nx * ny)];
        self.scene.centre(at).into()
    }
}

/// A fluid cell next to a wall, a solid or a block.
struct WallCell {
    /// Its index in an array over the domain, x fastest.
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
