//! Solid or fluid, cell by cell.

use crate::scene::{Axis, Face};

/// Which cells are solid, x fastest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    cells: [u32; 3],
    solid: Vec<u8>,
}

impl Mask {
    /// All fluid on a grid of `cells` along x, y, z.
    pub fn new(cells: [u32; 3]) -> Self {
        let count = cells.iter().map(|n| *n as usize).product();
        Self {
            cells,
            solid: vec![0; count],
        }
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

    /// Whether the cell `ijk` is solid.
    pub fn is_solid(&self, ijk: [u32; 3]) -> bool {
        self.solid[self.index(ijk)] != 0
    }

    /// Makes the cell `ijk` solid or fluid.
    pub fn set(&mut self, ijk: [u32; 3], solid: bool) {
        let index = self.index(ijk);
        self.solid[index] = u8::from(solid);
    }

    /// Number of solid cells.
    pub fn solid_count(&self) -> usize {
        self.solid.iter().filter(|s| **s != 0).count()
    }

    /// The cells beside `face` of the domain, the lower of the two in-plane axes fastest.
    pub fn face_cells(&self, face: Face) -> impl Iterator<Item = [u32; 3]> + use<> {
        let axis = face.axis().index();
        let [fast, slow] = face.axis().others().map(Axis::index);
        let cells = self.cells;
        let layer = if face.is_max() { cells[axis] - 1 } else { 0 };
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
