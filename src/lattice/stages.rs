//! The order in which cells at moving and open faces are completed.

use super::{FaceCell, Grid, MovingCell};
use std::collections::HashMap;
use std::ops::Range;

/// Most open faces that one cell touches with an inner neighbour behind each: one an axis.
pub const LAST_STAGE: usize = 3;

/// A cell of a face.
pub trait OfFace {
    /// Its index in the padded grid.
    fn cell(&self) -> u32;
}

impl OfFace for FaceCell {
    fn cell(&self) -> u32 {
        self.cell
    }
}

impl OfFace for MovingCell {
    fn cell(&self) -> u32 {
        self.cell
    }
}

/// How many open faces each cell touches.
///
/// An open face looks at the inner neighbour of its cell, which touches one open face less, and a
/// moving wall at all that comes into its own cell. So each stage, the cells of one number of open
/// faces, first completes the open faces and then the moving walls.
#[derive(Debug, Default)]
pub struct Stages(HashMap<u32, usize>);

impl Stages {
    /// Counts the faces of each cell.
    pub fn new(open: &[(usize, usize, Vec<FaceCell>)]) -> Self {
        let mut faces = HashMap::new();
        for cell in open.iter().flat_map(|(_, _, cells)| cells) {
            *faces.entry(cell.cell).or_default() += 1;
        }
        Self(faces)
    }

    fn of(&self, cell: &impl OfFace) -> usize {
        let faces = self.0.get(&cell.cell()).copied();
        faces.unwrap_or_default().min(LAST_STAGE)
    }

    /// Puts the cells of earlier stages first, and those of a stage in the order of memory.
    pub fn sort(&self, cells: &mut [impl OfFace], grid: &Grid) {
        cells.sort_by_key(|cell| (self.of(cell), grid.scalar_of(grid.padded_cell(cell.cell()))));
    }

    /// The places of the cells of a sorted list in an order that does not depend on how a grid lies in memory.
    pub fn canonical(&self, cells: &[impl OfFace]) -> Vec<usize> {
        let mut places: Vec<usize> = (0..cells.len()).collect();
        places.sort_by_key(|&place| (self.of(&cells[place]), cells[place].cell()));
        places
    }

    /// The cells of a stage in a sorted list.
    pub fn range(&self, cells: &[impl OfFace], stage: usize) -> Range<usize> {
        let first = cells.partition_point(|cell| self.of(cell) < stage);
        first..cells.partition_point(|cell| self.of(cell) <= stage)
    }
}
