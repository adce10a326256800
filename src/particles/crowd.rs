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
    cells: HashMap<[i64; 3], Vec<DVec3>>,
}

impl<'a> Crowd<'a> {
    pub fn new(lattice: &'a Lattice) -> Self {
        Self {
            lattice,
            // Points that stand exactly so far apart may both stay.
            distance: (NEAREST - 1e-6) * lattice.spacing,
            cells: HashMap::new(),
        }
    }

    /// Whether there is room for `point` (m), which then is there.
    pub fn admit(&mut self, point: DVec3) -> bool {
        if self.images(point).any(|image| self.is_near(image)) {
            return false;
        }
        self.cells.entry(self.cell(point)).or_default().push(point);
        true
    }

    fn cell(&self, point: DVec3) -> [i64; 3] {
        let cell = (point - self.lattice.low) / self.distance;
        cell.to_array().map(|c| c.floor() as i64)
    }

    fn is_near(&self, point: DVec3) -> bool {
        let [x, y, z] = self.cell(point);
        (-1..=1).any(|i| {
            (-1..=1).any(|j| {
                (-1..=1).any(|k| {
                    let there = self.cells.get(&[x + i, y + j, z + k]);
                    there
                        .into_iter()
                        .flatten()
                        .any(|other| other.distance(point) < self.distance)
                })
            })
        })
    }

    /// The point, and where it is seen once more near the ends of periods.
    fn images(&self, point: DVec3) -> impl Iterator<Item = DVec3> + use<> {
        let (low, high) = (self.lattice.low, self.lattice.high);
        let shifts: [[f64; 3]; 3] = std::array::from_fn(|axis| {
            let period = high[axis] - low[axis];
            let near = |end: f64| (point[axis] - end).abs() < self.distance;
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
