//! Means, extremes and forces over many cells.

use super::cells::Cells;
use crate::{output::Array, scene::Direction};

/// Mean, least and largest value of each component of `arrays`, in one row.
pub(super) fn box_rows(arrays: &[&Array]) -> Vec<Vec<f64>> {
    let mut row = Vec::new();
    for array in arrays {
        for component in 0..array.components {
            let values = array
                .values
                .iter()
                .skip(component)
                .step_by(array.components);
            row.extend(Statistics::of(values.map(|value| f64::from(*value))).triple());
        }
    }
    vec![row]
}

/// Mean and extremes.
struct Statistics {
    mean: f64,
    min: f64,
    max: f64,
    /// Place of the first largest value.
    at_max: usize,
}

impl Statistics {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut found = Self {
            mean: f64::NAN,
            min: f64::INFINITY,
            max: f64::NEG_INFINITY,
            at_max: 0,
        };
        let (mut sum, mut count) = (0.0, 0usize);
        for (place, value) in values.enumerate() {
            sum += value;
            count = place + 1;
            found.min = found.min.min(value);
            if value > found.max {
                (found.max, found.at_max) = (value, place);
            }
        }
        found.mean = sum / count as f64;
        found
    }

    fn triple(&self) -> [f64; 3] {
        [self.mean, self.min, self.max]
    }
}

/// The cell faces in which a static solid meets the fluid.
#[derive(Clone, Debug)]
pub(super) struct Face {
    /// Edge of a cell, m.
    cell: f64,
    /// Centres of the cell faces on the solid, m.
    centres: Vec<[f64; 3]>,
}

impl Face {
    pub(super) const COLUMNS: [&'static str; 8] = [
        "area",
        "pressure_mean",
        "pressure_min",
        "pressure_max",
        "force",
        "x_of_max",
        "y_of_max",
        "z_of_max",
    ];

    /// The fluid cells in a box (m) whose neighbour against `normal` is solid.
    pub(super) fn new(
        cells: &Cells<'_>,
        min: [f64; 3],
        max: [f64; 3],
        normal: Direction,
    ) -> (Self, Vec<u32>) {
        let (axis, sign) = (normal.axis().index(), normal.sign());
        let width = cells.domain.cell;
        let mut chosen = Vec::new();
        let mut centres = Vec::new();
        for ijk in cells.within(min, max) {
            let cell = cells.index(ijk);
            let behind = cells.neighbour(ijk, axis, -sign);
            if !cells.is_solid(cell) && behind.is_some_and(|behind| cells.is_solid(behind)) {
                chosen.push(cell);
                let mut centre = cells.domain.centre(ijk);
                centre[axis] -= 0.5 * f64::from(sign) * width;
                centres.push(centre);
            }
        }
        let face = Self {
            cell: width,
            centres,
        };
        (face, chosen)
    }

    /// One row from the pressure on the chosen cells.
    pub(super) fn rows(&self, arrays: &[&Array]) -> Vec<Vec<f64>> {
        let values = arrays.iter().flat_map(|array| &array.values);
        let pressure = Statistics::of(values.map(|value| f64::from(*value)));
        let area = self.centres.len() as f64 * self.cell * self.cell;
        let mut row = vec![area];
        row.extend(pressure.triple());
        row.push(pressure.mean * area);
        row.extend(self.centres[pressure.at_max]);
        vec![row]
    }
}
