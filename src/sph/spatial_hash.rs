//! Spatial hash of points with a least distance.

use super::particle_lattice::ParticleLattice;
use glam::DVec3;
use std::collections::HashMap;

/// Least distance of two boundary particles, in spacings. Two particles closer than that would weigh double in the
/// space of one.
pub(super) const MIN_DISTANCE: f64 = 0.6;

/// Points of which no two are closer than [`MIN_DISTANCE`] spacings, periodic images included.
pub(super) struct SpatialHash<'a> {
    lattice: &'a ParticleLattice,
    distance: f64,
    /// Edge of a cell, m.
    edge: f64,
    cells: HashMap<[i64; 3], Vec<DVec3>>,
}

impl<'a> SpatialHash<'a> {
    pub fn new(lattice: &'a ParticleLattice) -> Self {
        Self {
            lattice,
            // Points at exactly this distance are both kept.
            distance: (MIN_DISTANCE - 1e-6) * lattice.spacing,
            edge: lattice.spacing,
            cells: HashMap::new(),
        }
    }

    /// Inserts `point` (m) unless it is closer than the least distance to another point; returns whether it did.
    pub fn insert(&mut self, point: DVec3) -> bool {
        let has_space = self.nearest(point) >= self.distance;
        if has_space {
            self.cells.entry(self.cell(point)).or_default().push(point);
        }
        has_space
    }

    /// Distance from `point` (m) to the nearest inserted point, m; at most a spacing.
    pub fn nearest(&self, point: DVec3) -> f64 {
        let images = self.images(point).map(|image| self.nearest_to_image(image));
        images.fold(self.edge, f64::min)
    }

    fn cell(&self, point: DVec3) -> [i64; 3] {
        let cell = (point - self.lattice.low) / self.edge;
        cell.to_array().map(|c| c.floor() as i64)
    }

    fn nearest_to_image(&self, point: DVec3) -> f64 {
        let [x, y, z] = self.cell(point);
        let cells = (0..27).map(|i| [x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1]);
        let points = cells.filter_map(|cell| self.cells.get(&cell)).flatten();
        let distances = points.map(|other| other.distance_squared(point));
        distances.fold(f64::INFINITY, f64::min).sqrt()
    }

    /// The point and its periodic images within a spacing of the domain.
    fn images(&self, point: DVec3) -> impl Iterator<Item = DVec3> + use<> {
        let (low, high) = (self.lattice.low, self.lattice.high);
        let shifts: [[f64; 3]; 3] = std::array::from_fn(|axis| {
            let period = high[axis] - low[axis];
            let near = |end: f64| (point[axis] - end).abs() < self.edge;
            let image = |exists: bool, shift: f64| if exists { shift } else { 0.0 };
            let periodic = self.lattice.is_periodic(axis);
            [
                0.0,
                image(periodic && near(low[axis]), period),
                image(periodic && near(high[axis]), -period),
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
