//! Solid or fluid, cell by cell.

use crate::error::{Error, Result};
use crate::scene::{Axis, Face};

/// Which cells are solid, x fastest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    cells: [u32; 3],
    solid: Vec<u8>,
}

impl Mask {
    /// All fluid on a grid of `cells` along x, y, z.
    ///
    /// # Errors
    /// If they do not fit into memory.
    pub fn new(cells: [u32; 3]) -> Result<Self> {
        let count: u128 = cells.iter().map(|n| u128::from(*n)).product();
        let mut solid = Vec::new();
        let room = usize::try_from(count).ok();
        let room = room.filter(|count| solid.try_reserve_exact(*count).is_ok());
        let Some(room) = room else {
            let message = format!("{count} cells do not fit into memory; use a larger cell");
            return Err(Error::scene("domain.cell", message));
        };
        solid.resize(room, 0);
        Ok(Self { cells, solid })
    }

    /// Number of cells along x, y, z.
    pub fn cells(&self) -> [u32; 3] {
        self.cells
    }

    /// 1 for each solid cell, 0 for each fluid cell, x fastest.
    pub fn as_slice(&self) -> &[u8] {
        &self.solid
    }

    /// Place of the cell `ijk` in [`Self::as_slice`].
    pub fn index(&self, [i, j, k]: [u32; 3]) -> usize {
        let [nx, ny, _] = self.cells.map(|n| n as usize);
        (k as usize * ny + j as usize) * nx + i as usize
    }

    /// Whether the cell `ijk` is on the grid.
    fn has(&self, ijk: [u32; 3]) -> bool {
        (0..3).all(|axis| ijk[axis] < self.cells[axis])
    }

    /// Whether the cell `ijk` is solid; those outside of the grid are not.
    pub fn is_solid(&self, ijk: [u32; 3]) -> bool {
        self.has(ijk) && self.solid[self.index(ijk)] != 0
    }

    /// Makes the cell `ijk` solid or fluid; those outside of the grid stay as they are.
    pub fn set(&mut self, ijk: [u32; 3], solid: bool) {
        if self.has(ijk) {
            let index = self.index(ijk);
            self.solid[index] = u8::from(solid);
        }
    }

    /// Number of solid cells.
    pub fn solid_count(&self) -> usize {
        self.solid.iter().filter(|s| **s != 0).count()
    }

    /// The cells next to `face` of the domain, the lower of the two in-plane axes fastest.
    pub fn face_cells(&self, face: Face) -> impl Iterator<Item = [u32; 3]> + use<> {
        let axis = face.axis().index();
        let [fast, slow] = face.axis().others().map(Axis::index);
        let cells = self.cells;
        let layer = if face.is_max() {
            cells[axis].saturating_sub(1)
        } else {
            0
        };
        (0..cells[slow]).flat_map(move |s| {
            (0..cells[fast]).map(move |f| {
                let mut ijk = [layer; 3];
                ijk[fast] = f;
                ijk[slow] = s;
                ijk
            })
        })
    }
}
