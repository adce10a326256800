//! Cell data on a regular lattice, the host's picture of a flow at one time.

/// Values on the cells of a box, x running fastest, then y, then z.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Image {
    /// Lower corner of the domain (of the first cell, not its centre), m.
    pub origin: [f64; 3],
    /// Cell size, m.
    pub spacing: f64,
    /// Number of cells in x, y and z.
    pub cells: [usize; 3],
    /// The quantities; an array called `solid` marks the cells without fluid by values ≠ 0.
    pub arrays: Vec<Array>,
}

/// One quantity on every cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Array {
    /// Name shown in ParaView, with the quantity's SI unit implied by it.
    pub name: String,
    /// Components per cell: 1 for a scalar, 3 for a vector.
    pub components: usize,
    /// `components` values per cell, interleaved, in the unit of the quantity.
    pub values: Vec<f32>,
}

impl Image {
    /// The array called `name`.
    pub fn array(&self, name: &str) -> Option<&Array> {
        self.arrays.iter().find(|array| array.name == name)
    }

    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.cells.iter().product()
    }

    /// Position of cell (`i`, `j`, `k`) in an array of scalars.
    pub fn cell_index(&self, i: usize, j: usize, k: usize) -> usize {
        i + self.cells[0] * (j + self.cells[1] * k)
    }

    /// Whether cell number `cell` is solid; false where there is no array `solid`.
    pub fn is_solid(&self, cell: usize) -> bool {
        self.array("solid")
            .and_then(|solid| solid.values.get(cell))
            .is_some_and(|&value| value != 0.0)
    }

    /// What is wrong with the sizes, if anything: every array must fill every cell.
    pub(super) fn fault(&self) -> Option<String> {
        if self.spacing <= 0.0 || !self.spacing.is_finite() {
            return Some(format!(
                "the cell size is {} m; it must be positive and finite",
                self.spacing
            ));
        }
        let count = self.cell_count();
        self.arrays.iter().find_map(|array| {
            let wants = count * array.components;
            if array.components != 1 && array.components != 3 {
                Some(format!(
                    "array {} has {} components; give 1 for a scalar or 3 for a vector",
                    array.name, array.components
                ))
            } else if array.values.len() != wants {
                Some(format!(
                    "array {} has {} values; {:?} cells of {} components need {wants}",
                    array.name,
                    array.values.len(),
                    self.cells,
                    array.components
                ))
            } else {
                None
            }
        })
    }
}
