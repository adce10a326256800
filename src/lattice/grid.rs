//! Memory layout of cells: padding, lanes, elements, bricks.

use super::{Setup, Storage};
use crate::{Error, Result, gpu::kernel::MAX_GROUPS};

/// Largest number of cells of a grid: indices have 32 bits, including the padding of a folded dispatch.
const MAX_CELLS: u32 = u32::MAX - 64 * MAX_GROUPS;

/// The grid in memory.
///
/// Axes that are not periodic have a layer of non-fluid cells after the last one, which
/// receives the populations that fluid cells send into the walls on both sides. Along `lane_axis` the domain is divided into
/// `lanes` slabs; an element holds one cell of each slab.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Number of fluid cells along each axis.
    pub cells: [u32; 3],
    /// Number of elements along each axis, padding included.
    pub elements: [u32; 3],
    /// Cells per element.
    pub lanes: u32,
    /// The axis along which the domain is divided into lanes, 1 or 2.
    pub lane_axis: usize,
    /// Elements of a brick along each axis.
    pub brick: [u32; 3],
}

impl Grid {
    /// The grid of a setup.
    ///
    /// # Errors
    /// If a periodic lane axis is not divisible by the number of lanes, or the grid has too many cells for an
    /// index.
    pub fn new(setup: &Setup) -> Result<Self> {
        if setup.cells.contains(&0) {
            return Err(Error::argument(
                "cells",
                "each axis needs at least one cell",
            ));
        }
        let lanes = setup.lanes;
        let allowed: &[u32] = match setup.storage {
            Storage::F32 => &[1, 4],
            Storage::F16 => &[2, 4],
        };
        if !allowed.contains(&lanes) {
            let message = format!(
                "{:?} storage needs one of {allowed:?} lanes, not {lanes}",
                setup.storage
            );
            return Err(Error::argument("lanes", message));
        }
        let periodic = setup.periodic_axes();
        let pad = |n: u32, axis: usize| n.saturating_add(u32::from(!periodic[axis]));
        let axis = setup.lane_axis;
        let depth = pad(setup.cells[axis], axis);
        if periodic[axis] && depth % lanes != 0 {
            let name = ["x", "y", "z"][axis];
            return Err(Error::argument(
                "lanes",
                format!(
                    "{depth} cells along a periodic {name} do not divide into {lanes} lanes; use {} or {} \
                     cells, or walls, or another number of lanes",
                    depth - depth % lanes,
                    depth.saturating_add(lanes - depth % lanes)
                ),
            ));
        }
        let mut elements = [0, 1, 2].map(|axis| pad(setup.cells[axis], axis));
        elements[axis] = depth.div_ceil(lanes);
        if !periodic[0] {
            let rows = elements[0].checked_next_multiple_of(setup.row_alignment);
            elements[0] = rows.unwrap_or(elements[0]);
        }
        let elements_all = elements.iter().map(|&n| u128::from(n)).product::<u128>();
        let total = elements_all * u128::from(lanes);
        let most = u64::from(MAX_CELLS);
        if total > u128::from(most) {
            return Err(Error::Limit {
                name: "cells of one grid".into(),
                wants: u64::try_from(total).unwrap_or(u64::MAX),
                has: most,
                remedy: "use a larger cell".into(),
            });
        }
        Ok(Self {
            cells: setup.cells,
            elements,
            lanes,
            lane_axis: axis,
            brick: setup.brick,
        })
    }

    /// Number of elements.
    pub fn element_count(&self) -> u32 {
        self.elements.iter().product()
    }

    /// Number of cells of all elements, padding included.
    pub fn scalar_count(&self) -> u32 {
        self.element_count() * self.lanes
    }

    /// Number of fluid cells.
    pub fn cell_count(&self) -> usize {
        self.cells.iter().map(|&n| n as usize).product()
    }

    /// Cells of an element along an axis.
    pub fn lanes_along(&self, axis: usize) -> u32 {
        if axis == self.lane_axis {
            self.lanes
        } else {
            1
        }
    }

    /// Number of cells along each axis, padding included.
    pub fn padded(&self) -> [u32; 3] {
        [0, 1, 2].map(|axis| self.elements[axis] * self.lanes_along(axis))
    }

    /// Number of bricks along each axis.
    pub fn bricks(&self) -> [u32; 3] {
        [0, 1, 2].map(|a| self.elements[a].div_ceil(self.brick[a]))
    }

    /// Element and lane of a cell of the padded grid.
    pub fn element_of(&self, [x, y, z]: [u32; 3]) -> (u32, u32) {
        let [nx, ny, nz] = self.elements;
        let element = x + nx * (y % ny + ny * (z % nz));
        (element, y / ny + z / nz)
    }

    /// The brick of a cell, numbered as in [`Grid::bricks`] with x fastest, and its index there: element, then lane.
    pub(super) fn place_in_bricks(&self, cell: [u32; 3]) -> (u32, u32) {
        let [nx, ny, _] = self.elements;
        let (element, lane) = self.element_of(cell);
        let at = [element % nx, element / nx % ny, element / (nx * ny)];
        let [bx, by, _] = self.bricks();
        let [sx, sy, sz] = self.brick;
        let brick = at[0] / sx + bx * (at[1] / sy + by * (at[2] / sz));
        let place = at[0] % sx + sx * (at[1] % sy + sy * (at[2] % sz));
        (brick, place * self.lanes + lane)
    }

    /// Index of a cell among the scalars of a direction: the lanes of an element are neighbours.
    pub fn scalar_of(&self, cell: [u32; 3]) -> u32 {
        let (element, lane) = self.element_of(cell);
        element * self.lanes + lane
    }

    /// Cell n of the padded grid, x fastest.
    pub fn padded_cell(&self, n: u32) -> [u32; 3] {
        let [nx, ny, _] = self.padded();
        [n % nx, (n / nx) % ny, n / (nx * ny)]
    }

    /// Whether a cell of the padded grid is one of the domain.
    pub fn contains(&self, cell: [u32; 3]) -> bool {
        (0..3).all(|a| cell[a] < self.cells[a])
    }

    /// The neighbour on the torus of the padded grid.
    pub fn neighbour(&self, cell: [u32; 3], c: [i32; 3]) -> [u32; 3] {
        let n = self.padded();
        [0, 1, 2].map(|a| (i64::from(cell[a]) + i64::from(c[a])).rem_euclid(n[a].into()) as u32)
    }

    /// The cell of the domain next to one in a direction, across periodic faces too; none outside.
    pub(crate) fn neighbour_in_domain(
        &self,
        cell: [u32; 3],
        c: [i32; 3],
        periodic: [bool; 3],
    ) -> Option<[u32; 3]> {
        let mut to = cell;
        for a in 0..3 {
            let n = i64::from(self.cells[a]);
            let at = i64::from(cell[a]) + i64::from(c[a]);
            if !periodic[a] && !(0..n).contains(&at) {
                return None;
            }
            to[a] = at.rem_euclid(n) as u32;
        }
        Some(to)
    }

    /// Index of a domain cell, x fastest.
    pub fn index(&self, [x, y, z]: [u32; 3]) -> usize {
        let [nx, ny, _] = self.cells.map(|n| n as usize);
        x as usize + nx * (y as usize + ny * z as usize)
    }

    /// The domain cells in the order of [`Grid::index`].
    pub fn domain(&self) -> impl Iterator<Item = [u32; 3]> + use<> {
        let [nx, ny, nz] = self.cells;
        (0..nz).flat_map(move |z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])))
    }
}
