//! Values at a point, along a line or on the cells of a plane; means, extremes and forces over many cells.

use super::cells::{Cells, Share, shares, weight};
use crate::{
    output::{Array, ImageData},
    scene::{Axis, Direction, Field, Scene},
};

/// Points with their coordinates and the cells that contribute to them.
#[derive(Clone, Debug)]
pub(super) struct Points(Vec<Point>);

#[derive(Clone, Debug)]
struct Point {
    /// Columns in front of the fields.
    coordinates: Vec<f64>,
    /// Contributions to its value, with cells as indices into the list of cells; empty in a solid.
    shares: Vec<Share>,
    /// What the weight of the fluid between them and the point adds to their pressure, Pa.
    weight: f64,
    /// The cell around it, as an index into the list of cells; `None` in a solid.
    own: Option<u32>,
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
                weight: 0.0,
                own: (!solid).then_some(cell),
            }
        });
        numbered(points.collect())
    }

    /// One row per point: coordinates, then the values of `fields` from `arrays` on the chosen cells.
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
            let fraction = |cell: u32| array.values[cell as usize].into();
            return self.own.map_or(1.0, fraction);
        }
        if self.shares.is_empty() {
            return f64::NAN;
        }
        let of = |share: &Share| match share.wall {
            Some(wall) if field == Field::Velocity => wall[component],
            _ => array.values[share.cell as usize * array.components + component].into(),
        };
        let value: f64 = self.shares.iter().map(|s| s.weight * of(s)).sum();
        match field {
            Field::Pressure | Field::MeanPressure => value + self.weight,
            _ => value,
        }
    }
}

fn point(cells: &Cells<'_>, at: [f64; 3], coordinates: Vec<f64>) -> Point {
    let around = Axis::ALL.map(|axis| cells.layer(axis, at[axis.index()]));
    let shares = shares(cells, at);
    let own = cells.index(around);
    Point {
        coordinates,
        weight: weight(cells, at, &shares),
        shares,
        own: (!cells.is_solid(own)).then_some(own),
    }
}

/// The points, with their cells as indices into the returned list, in which each cell occurs once.
fn numbered(mut points: Vec<Point>) -> (Points, Vec<u32>) {
    let shares = |points: &[Point]| -> Vec<u32> {
        let cells = points.iter().flat_map(|point| {
            let shared = point.shares.iter().map(|share| share.cell);
            shared.chain(point.own)
        });
        cells.collect()
    };
    let mut list = shares(&points);
    list.sort_unstable();
    list.dedup();
    let number = |cell: u32| list.partition_point(|other| *other < cell) as u32;
    for point in &mut points {
        point.own = point.own.map(number);
        for share in &mut point.shares {
            share.cell = number(share.cell);
        }
    }
    (Points(points), list)
}

/// One layer of a scene's cells, as an image of its own.
#[derive(Clone, Debug)]
pub struct Layer {
    frame: ImageData,
    cells: Vec<u32>,
}

impl Layer {
    /// The layer normal to `axis` around `position` (m); the upper one on the face between two layers.
    pub fn new(scene: &Scene, axis: Axis, position: f64) -> Self {
        let cells = Cells::new(scene, &[]);
        let number = cells.layer(axis, position);
        let mut counts = cells.counts.map(|n| n as usize);
        counts[axis.index()] = 1;
        let mut origin = scene.domain.origin;
        origin[axis.index()] += f64::from(number) * scene.domain.cell;
        Self {
            frame: ImageData {
                origin,
                spacing: scene.domain.cell,
                cells: counts,
                arrays: Vec::new(),
            },
            cells: cells
                .of_layer(axis, number)
                .map(|c| cells.index(c))
                .collect(),
        }
    }

    /// Its cells as indices into an array over the domain, x fastest.
    pub fn cells(&self) -> &[u32] {
        &self.cells
    }

    /// The layer as an image without arrays, to be filled on [`Layer::cells`].
    pub fn frame(&self) -> ImageData {
        self.frame.clone()
    }
}

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
    /// Index of the first largest value.
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

/// The cell faces at which a static solid meets the fluid.
#[derive(Clone, Debug)]
pub(super) struct Face {
    /// Edge of a cell, m.
    cell: f64,
    /// Centres of the cell faces on the solid, m.
    centres: Vec<[f64; 3]>,
    /// Pressure of the fluid at rest at the faces over that at the centres of their cells, Pa.
    weight: f64,
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

    /// The fluid cells in a box (m) whose neighbour in the direction opposite to `normal` is solid.
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
            weight: -0.5 * f64::from(sign) * width * cells.gradient[axis],
        };
        (face, chosen)
    }

    /// One row from the pressure on the chosen cells.
    pub(super) fn rows(&self, arrays: &[&Array]) -> Vec<Vec<f64>> {
        let values = arrays.iter().flat_map(|array| &array.values);
        let pressure = Statistics::of(values.map(|value| f64::from(*value) + self.weight));
        let area = self.centres.len() as f64 * self.cell * self.cell;
        let mut row = vec![area];
        row.extend(pressure.triple());
        row.push(pressure.mean * area);
        row.extend(self.centres[pressure.at_max]);
        vec![row]
    }
}
