//! Where a cell lies: padding, lanes, elements, bricks.

use super::{Setup, Storage};
use crate::{Error, Result, gpu::kernel::MAX_GROUPS};

/// Most cells of a grid: each has an index of 32 bits, and so has what folding a dispatch adds.
const MAX_CELLS: u32 = u32::MAX - 64 * MAX_GROUPS;

/// The grid as it lies in memory.
///
/// Axes that are not periodic carry a layer of cells that are not fluid behind the last one: it
/// holds what fluid cells send into the walls on both sides. Along z, `lanes` slabs of `slices`
/// cells lie side by side in each element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Fluid cells an axis.
    pub cells: [u32; 3],
    /// Elements an axis, padding included.
    pub elements: [u32; 3],
    /// Cells an element.
    pub lanes: u32,
    /// Elements of a brick an axis.
    pub brick: [u32; 3],
}

impl Grid {
    /// The grid of a setup.
    ///
    /// # Errors
    /// If a periodic z axis does not divide into the lanes, or the grid has more cells than an
    /// index holds.
    pub fn new(setup: &Setup) -> Result<Self> {
        let [x, y, z] = setup.cells;
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
        let depth = pad(z, 2);
        if periodic[2] && depth % lanes != 0 {
            return Err(Error::argument(
                "lanes",
                format!(
                    "{depth} cells along a periodic z do not divide into {lanes} lanes; use {} or {} \
                     cells, or walls, or another number of lanes",
                    depth - depth % lanes,
                    depth.saturating_add(lanes - depth % lanes)
                ),
            ));
        }
        let elements = [pad(x, 0), pad(y, 1), depth.div_ceil(lanes)];
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
            brick: setup.brick,
        })
    }

    /// Elements in all.
    pub fn element_count(&self) -> u32 {
        self.elements.iter().product()
    }

    /// Cells of all elements, padding included.
    pub fn scalar_count(&self) -> u32 {
        self.element_count() * self.lanes
    }

    /// Fluid cells in all.
    pub fn cell_count(&self) -> usize {
        self.cells.iter().map(|&n| n as usize).product()
    }

    /// Cells an axis, padding included.
    pub fn padded(&self) -> [u32; 3] {
        let [x, y, s] = self.elements;
        [x, y, s * self.lanes]
    }

    /// Bricks an axis.
    pub fn bricks(&self) -> [u32; 3] {
        [0, 1, 2].map(|a| self.elements[a].div_ceil(self.brick[a]))
    }

    /// Element and lane of a cell of the padded grid.
    pub fn element_of(&self, [x, y, z]: [u32; 3]) -> (u32, u32) {
        let [nx, ny, slices] = self.elements;
        (x + nx * (y + ny * (z % slices)), z / slices)
    }

    /// Index of a cell among the scalars of a direction: the lanes of an element are neighbours.
    pub fn scalar_of(&self, cell: [u32; 3]) -> u32 {
        let (element, lane) = self.element_of(cell);
        element * self.lanes + lane
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
