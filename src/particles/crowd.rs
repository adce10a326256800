//! Points that keep a distance.

use super::lattice::Lattice;
use glam::DVec3;
use std::collections::HashMap;

/// Least distance of two shell points, of the spacing: below it they would weigh as two where there is room
/// for one.
pub(super) const NEAREST: f64 = 0.6;

/// Points of which no two are nearer than [`NEAREST`] spacings, periodic images included.
pub(super) struct Crowd<'a> {
    lattice: &'a Lattice,
    distance: f64,
    /// Edge of a cell, m.
    edge: f64,
    cells: HashMap<[i64; 3], Vec<DVec3>>,
}

impl<'a> Crowd<'a> {
    pub fn new(lattice: &'a Lattice) -> Self {
        Self {
            lattice,
            // Points that stand exactly so far apart may both stay.
            distance: (NEAREST - 1e-6) * lattice.spacing,
            edge: lattice.spacing,
            cells: HashMap::new(),
        }
    }

    /// Whether there is room for `point` (m), which then is there.
    pub fn admit(&mut self, point: DVec3) -> bool {
        let admitted = self.nearest(point) >= self.distance;
        if admitted {
            self.cells.entry(self.cell(point)).or_default().push(point);
        }
        admitted
    }

    /// Distance from `point` (m) to the nearest of them, m; a spacing if that is farther.
    pub fn nearest(&self, point: DVec3) -> f64 {
        let images = self.images(point).map(|image| self.nearest_of_one(image));
        images.fold(self.edge, f64::min)
    }

    fn cell(&self, point: DVec3) -> [i64; 3] {
        let cell = (point - self.lattice.low) / self.edge;
        cell.to_array().map(|c| c.floor() as i64)
    }

    fn nearest_of_one(&self, point: DVec3) -> f64 {
        let [x, y, z] = self.cell(point);
        let around = (0..27).map(|i| [x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1]);
        let there = around.filter_map(|cell| self.cells.get(&cell)).flatten();
        let distances = there.map(|other| other.distance_squared(point));
        distances.fold(f64::INFINITY, f64::min).sqrt()
    }

    /// The point, and where it is seen once more near the ends of periods.
    fn images(&self, point: DVec3) -> impl Iterator<Item = DVec3> + use<> {
        let (low, high) = (self.lattice.low, self.lattice.high);
        let shifts: [[f64; 3]; 3] = std::array::from_fn(|axis| {
            let period = high[axis] - low[axis];
            let near = |end: f64| (point[axis] - end).abs() < self.edge;
            let seen = |there: bool, shift: f64| if there { shift } else { 0.0 };
            let periodic = self.lattice.periodic[axis];
            [
                0.0,
                seen(periodic && near(low[axis]), period),
                seen(periodic && near(high[axis]), -period),
            ]
        });
        let shift =
            move |i: usize| DVec3::new(shifts[0][i % 3], shifts[1][i / 3 % 3], shifts[2][i / 9]);
        (0..27)
            .map(shift)
            .enumerate()
            .filter(|(i, shift)| *i == 0 || *shift != DVec3::ZERO)
            .map(move |(_, shift)| point + shift)
    }
}
