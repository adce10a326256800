//! A plane through a fluid, coloured by a quantity.

use super::drawing::{Colours, check_finite};
use crate::picture::colour_bar::ColourBar;
use crate::picture::{Palette, Plane, Section};
use glam::DVec3;
use riprap::Result;

/// A quantity on the cells that a plane passes through. Its colours are exactly those of the colour bar: it is neither lit
/// nor shadowed.
#[derive(Clone, Debug, PartialEq)]
pub struct FluidPlane {
    /// The plane.
    pub plane: Plane,
    /// Lower corner along the two other axes in their order, m.
    pub origin: [f64; 2],
    /// Cell size, m.
    pub spacing: f64,
    /// Number of cells along both axes.
    pub cells: [usize; 2],
    /// The quantity, the first axis running fastest; NaN for cells without fluid, which leave holes.
    pub values: Vec<f32>,
    /// Meaning of the values.
    pub colours: Colours,
}

impl FluidPlane {
    /// The plane of `section`, which was cut by `plane`. Solid cells are left out, except those of a solid that the section
    /// has as a block: the block is drawn over them.
    pub fn of(section: &Section, plane: Plane, colours: Colours) -> Self {
        let value = |cell: usize| match section.values[cell] as f32 {
            _ if section.solid[cell] && !section.in_blocks[cell] => f32::NAN,
            // Infinite, so that the fault is visible.
            value if value.is_nan() && section.is_fluid(cell) => f32::INFINITY,
            value => value,
        };
        Self {
            plane,
            origin: section.origin,
            spacing: section.spacing,
            cells: section.cells,
            values: (0..section.values.len()).map(value).collect(),
            colours,
        }
    }

    /// Its lower corner, and the edges that begin there, m.
    pub(super) fn rectangle(&self) -> [DVec3; 3] {
        let others = self.plane.others();
        let mut corner = DVec3::ZERO;
        corner[self.plane.normal] = self.plane.position;
        let mut edges = [DVec3::ZERO; 2];
        for (along, axis) in others.into_iter().enumerate() {
            corner[axis] = self.origin[along];
            edges[along][axis] = self.spacing * self.cells[along] as f64;
        }
        [corner, edges[0], edges[1]]
    }

    /// Its corners in their order around it, m.
    pub(super) fn corners(&self) -> [DVec3; 4] {
        let [corner, along, up] = self.rectangle();
        [corner, corner + along, corner + along + up, corner + up]
    }

    pub(super) fn bar(&self, index: usize) -> Result<ColourBar> {
        let values = self.values.iter().map(|value| f64::from(*value));
        let name = format!("planes[{index}]");
        self.colours.bar(&name, values, Palette::Sequential, false)
    }

    pub(super) fn check(&self) -> std::result::Result<(), String> {
        if self.plane.normal > 2 {
            let axis = self.plane.normal;
            return Err(format!(
                "it is normal to axis {axis}; give 0 (x), 1 (y) or 2 (z)"
            ));
        }
        let count = self.cells[0] * self.cells[1];
        if count == 0 || self.values.len() != count {
            return Err(format!(
                "it has {} values for {} × {} cells; give each cell one, and one cell at least",
                self.values.len(),
                self.cells[0],
                self.cells[1]
            ));
        }
        if !(self.spacing.is_finite() && self.spacing > 0.0) {
            return Err(format!(
                "its cells have {} m; give a positive size",
                self.spacing
            ));
        }
        check_finite(&self.corners())
    }
}
