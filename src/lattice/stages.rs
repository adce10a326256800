//! The order in which cells at moving and open faces are completed.

use super::{FaceCell, Grid, MovingCell};
use std::collections::HashMap;
use std::ops::Range;

/// Most open faces that one cell touches with an inner neighbour behind each: one an axis.
pub const LAST_STAGE: usize = 3;

/// Faces of a cell.
pub const FACES: usize = 6;

/// A cell of a face.
pub trait OfFace {
    /// Its index in the padded grid.
    fn cell(&self) -> u32;

    /// Its turn among the dispatches of a stage.
    fn turn(&self) -> u32 {
        0
    }
}

impl OfFace for FaceCell {
    fn cell(&self) -> u32 {
        self.cell
    }

    fn turn(&self) -> u32 {
        self.turn
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
    pub fn new(open: [&[FaceCell]; 2]) -> Self {
        let mut faces = HashMap::new();
        for cell in open.into_iter().flatten() {
            *faces.entry(cell.cell).or_default() += 1;
        }
        Self(faces)
    }

    /// Stage and turn of a cell.
    fn of(&self, cell: &impl OfFace) -> (usize, u32) {
        let faces = self.0.get(&cell.cell()).copied();
        let stage = faces.unwrap_or_default().min(LAST_STAGE);
        (stage, cell.turn())
    }

    /// Puts the cells of earlier stages and turns first, and those of a turn in the order of memory.
    pub fn sort(&self, cells: &mut [impl OfFace], grid: &Grid) {
        cells.sort_by_key(|cell| (self.of(cell), grid.scalar_of(grid.padded_cell(cell.cell()))));
    }

    /// The places of the cells of a sorted list in an order that does not depend on how a grid lies in memory.
    pub fn canonical(&self, cells: &[impl OfFace]) -> Vec<usize> {
        let mut places: Vec<usize> = (0..cells.len()).collect();
        places.sort_by_key(|&place| (self.of(&cells[place]), cells[place].cell()));
        places
    }

    /// The cells of the turns of a stage in a sorted list.
    pub fn turns(&self, cells: &[impl OfFace], stage: usize) -> Vec<Range<usize>> {
        let range = |turn| {
            let first = cells.partition_point(|cell| self.of(cell) < (stage, turn));
            first..cells.partition_point(|cell| self.of(cell) <= (stage, turn))
        };
        let turns = (0..=FACES as u32).map(range);
        turns.filter(|range| !range.is_empty()).collect()
    }
}
