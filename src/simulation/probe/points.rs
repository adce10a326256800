//! Values at points: one, along a line, on the cells of a plane.

use super::cells::Cells;
use super::interpolate::{Share, shares};
use crate::{
    output::Array,
    scene::{Axis, Field},
};

/// Points with their coordinates and the cells that they follow from.
#[derive(Clone, Debug)]
pub(super) struct Points(Vec<Point>);

#[derive(Clone, Debug)]
struct Point {
    /// What stands in front of the fields.
    coordinates: Vec<f64>,
    /// Shares of its value, their cells as places in the list of cells; none in a solid.
    shares: Vec<Share>,
    /// Whether the cell around it is solid.
    solid: bool,
}

impl Points {
    /// The point at `at` (m), and the cells it needs.
    pub(super) fn single(cells: &Cells<'_>, at: [f64; 3]) -> (Self, Vec<u32>) {
        numbered(vec![point(cells, at, vec![])])
    }

    /// The points of a line with their distances from its beginning (m).
    pub(super) fn line(cells: &Cells<'_>, stations: Vec<(f64, [f64; 3])>) -> (Self, Vec<u32>) {
        let points = stations.into_iter();
        let points = points.map(|(s, [x, y, z])| point(cells, [x, y, z], vec![s, x, y, z]));
        numbered(points.collect())
    }

    /// The centres of the cells that the plane at `position` (m) cuts.
    pub(super) fn plane(cells: &Cells<'_>, axis: Axis, position: f64) -> (Self, Vec<u32>) {
        let layer = cells.of_layer(axis, cells.layer(axis, position));
        let points = layer.map(|ijk| {
            let cell = cells.index(ijk);
            let solid = cells.is_solid(cell);
            let own = Share {
                cell,
                weight: 1.0,
                wall: None,
            };
            Point {
                coordinates: cells.domain.centre(ijk).to_vec(),
                shares: if solid { vec![] } else { vec![own] },
                solid,
            }
        });
        numbered(points.collect())
    }

    /// A row a point: coordinates, then `arrays` of `fields` on the chosen cells.
    pub(super) fn rows(&self, fields: &[Field], arrays: &[&Array]) -> Vec<Vec<f64>> {
        let row = |point: &Point| {
            let mut row = point.coordinates.clone();
            for (field, array) in fields.iter().zip(arrays) {
                for component in 0..array.components {
                    row.push(point.value(*field, array, component));
                }
            }
            row
        };
        self.0.iter().map(row).collect()
    }
}

impl Point {
    fn value(&self, field: Field, array: &Array, component: usize) -> f64 {
        if field == Field::Solid {
            return f64::from(u8::from(self.solid));
        }
        if self.shares.is_empty() {
            return f64::NAN;
        }
        let of = |share: &Share| match share.wall {
            Some(wall) if field == Field::Velocity => wall[component],
            _ => array.values[share.cell as usize * array.components + component].into(),
        };
        self.shares.iter().map(|s| s.weight * of(s)).sum()
    }
}

fn point(cells: &Cells<'_>, at: [f64; 3], coordinates: Vec<f64>) -> Point {
    let around = Axis::ALL.map(|axis| cells.layer(axis, at[axis.index()]));
    Point {
        coordinates,
        shares: shares(cells, at),
        solid: cells.is_solid(cells.index(around)),
    }
}

/// Each cell that the points need once, and the points with their cells numbered in that list.
fn numbered(mut points: Vec<Point>) -> (Points, Vec<u32>) {
    let shares = |points: &[Point]| -> Vec<u32> {
        let all = points.iter().flat_map(|point| &point.shares);
        all.map(|share| share.cell).collect()
    };
    let mut list = shares(&points);
    list.sort_unstable();
    list.dedup();
    for share in points.iter_mut().flat_map(|point| &mut point.shares) {
        share.cell = list.partition_point(|cell| *cell < share.cell) as u32;
    }
    (Points(points), list)
}
