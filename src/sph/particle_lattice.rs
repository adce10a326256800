//! The initial lattice of the particles in the domain, and a spatial hash of points with a least distance.

use super::{Side, solid::ConvexPart};
use crate::{geometry::HalfSpace, random::uniform, rock::Block};
use glam::DVec3;
use std::collections::HashMap;

/// Points (i + ½) Δx from the lower corner of the domain.
#[derive(Clone, Copy, Debug)]
pub struct ParticleLattice {
    /// Lower corner of the domain, m.
    pub low: DVec3,
    /// Upper corner of the domain, m.
    pub high: DVec3,
    /// Δx, m.
    pub spacing: f64,
    /// Layers of boundary particles.
    pub layers: u32,
    /// Lower and upper face of the domain along each axis.
    pub faces: [[Side; 2]; 3],
    /// Whether the scene is planar, with one row along y in the middle.
    pub plane: bool,
}

impl ParticleLattice {
    /// Whether the domain is periodic along `axis`.
    pub fn is_periodic(&self, axis: usize) -> bool {
        self.faces[axis][0] == Side::Periodic
    }

    /// The faces of the domain of one `kind`, each as its axis and whether it is the upper face: x_min, x_max, y_min and so on.
    pub(super) fn faces_of(&self, kind: Side) -> impl Iterator<Item = (usize, bool)> {
        let faces = self.faces.into_iter().enumerate();
        let faces = faces.flat_map(|(axis, [low, high])| [(axis, false, low), (axis, true, high)]);
        faces.filter_map(move |(axis, is_upper, side)| (side == kind).then_some((axis, is_upper)))
    }

    /// Length far below the spacing and far above the rounding error of a coordinate, m.
    pub fn tolerance(&self) -> f64 {
        1e-6 * self.spacing
    }

    /// Depth of a layer, m.
    pub fn depth(&self, layer: u32) -> f64 {
        (f64::from(layer) + 0.5) * self.spacing
    }

    /// Reproducible random displacement of particle `index`, at most a spacing along each axis, m.
    pub fn jitter(&self, index: usize) -> DVec3 {
        let jitter = [0, 1, 2].map(|axis| {
            if self.is_planar_axis(axis) {
                0.0
            } else {
                2.0 * uniform(0, &[index as i64, axis as i64]) - 1.0
            }
        });
        self.spacing * DVec3::from(jitter)
    }

    /// Whether the domain has no ends along `axis`.
    pub fn is_unbounded(&self, axis: usize) -> bool {
        self.is_periodic(axis) || self.is_planar_axis(axis)
    }

    /// Whether a block shorter than the period crosses an end of the period along `axis`.
    pub fn crosses_period(&self, block: &Block, axis: usize) -> bool {
        let parts = ConvexPart::of_block(block);
        let low = parts.iter().map(|part| part.low[axis]);
        let high = parts.iter().map(|part| part.high[axis]);
        let low = low.fold(f64::INFINITY, f64::min);
        let high = high.fold(f64::NEG_INFINITY, f64::max);
        let is_shorter = high - low < self.high[axis] - self.low[axis];
        is_shorter && (low < self.low[axis] || high > self.high[axis])
    }

    /// The periodic image of `x` (m) inside the domain.
    pub fn wrapped(&self, mut x: DVec3) -> DVec3 {
        for axis in (0..3).filter(|axis| self.is_periodic(*axis)) {
            let period = self.high[axis] - self.low[axis];
            x[axis] = self.low[axis] + (x[axis] - self.low[axis]).rem_euclid(period);
        }
        x
    }

    fn is_planar_axis(&self, axis: usize) -> bool {
        self.plane && axis == 1
    }

    /// Extent of boundary particles along `axis`: the domain, and all layers beyond its ends, m.
    pub fn extent_with_layers(&self, axis: usize) -> [f64; 2] {
        let beyond = if self.is_unbounded(axis) {
            0.0
        } else {
            f64::from(self.layers) * self.spacing
        };
        [self.low[axis] - beyond, self.high[axis] + beyond]
    }

    /// Whether a boundary particle of a fixed block may be at `x` (m).
    pub fn is_within(&self, x: DVec3) -> bool {
        (0..3).all(|axis| {
            let [low, high] = self.extent_with_layers(axis);
            let inside = x[axis] >= low && x[axis] <= high;
            inside
                && (!self.is_planar_axis(axis)
                    || (x[axis] - 0.5 * (low + high)).abs() < self.tolerance())
        })
    }

    /// Extent of boundary particles along `axis` as half-spaces.
    pub fn half_spaces(&self, axis: usize) -> [HalfSpace; 2] {
        let [low, high] = self.extent_with_layers(axis);
        [
            HalfSpace {
                normal: -DVec3::AXES[axis],
                distance: -low,
            },
            HalfSpace {
                normal: DVec3::AXES[axis],
                distance: high,
            },
        ]
    }

    /// Lattice coordinates along `axis` from `from` to `to` (m), ends included; one period of them if the range spans it.
    pub fn row(&self, axis: usize, [from, to]: [f64; 2]) -> Vec<f64> {
        if self.is_planar_axis(axis) {
            return vec![0.5 * (self.low[axis] + self.high[axis])];
        }
        let index = |x: f64| (x - self.low[axis]) / self.spacing - 0.5;
        let (first, last) = (index(from) - 1e-6, index(to) + 1e-6);
        let (mut first, mut last) = (first.ceil() as i64, last.floor() as i64);
        let period = self.high[axis] - self.low[axis];
        if self.is_periodic(axis) && to - from > period - self.tolerance() {
            let count = (period / self.spacing).round() as i64;
            (first, last) = (first.max(0), last.min(count - 1));
        }
        (first..=last)
            .map(|i| self.low[axis] + (i as f64 + 0.5) * self.spacing)
            .collect()
    }

    /// The coordinates of [`ParticleLattice::row`], and also the `end` (m) of the range if it keeps the least distance from
    /// all of them.
    pub fn row_to(&self, axis: usize, range: [f64; 2], end: f64) -> Vec<f64> {
        let mut row = self.row(axis, range);
        let least = MIN_DISTANCE * self.spacing;
        if row.iter().all(|at| (at - end).abs() >= least) {
            row.push(end);
        }
        row
    }

    /// The coordinates of [`ParticleLattice::row`] for a range beyond whose `end` (m) another layer continues after one
    /// spacing, and one more in the middle of the remaining interval if that is long enough.
    pub fn row_to_inset_edge(&self, axis: usize, range: [f64; 2], end: f64) -> Vec<f64> {
        let mut row = self.row(axis, range);
        let upward = end == range[1];
        let Some(last) = (if upward { row.last() } else { row.first() }) else {
            return vec![end];
        };
        let beyond = if upward { self.spacing } else { -self.spacing };
        let middle = last.midpoint(end + beyond);
        if (middle - last).abs() >= MIN_DISTANCE * self.spacing {
            row.push(middle);
        }
        row
    }

    /// Evenly spaced coordinates from `from` to `to` (m), both included, about one spacing apart.
    pub fn evenly_spaced(&self, [from, to]: [f64; 2]) -> Vec<f64> {
        let length = to - from;
        // A single interval must be at least the least distance long.
        let mut count = (length / self.spacing).round();
        if count == 1.0 && length < MIN_DISTANCE * self.spacing {
            count = 0.0;
        }
        if count <= 0.0 {
            return vec![0.5 * (from + to)];
        }
        (0..=count as u64)
            .map(|i| from + length * (i as f64 / count))
            .collect()
    }
}

/// Least distance of two boundary particles, in spacings. Two closer particles would count twice in the space of one.
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

    /// Inserts `point` (m) unless it is closer than the least distance to another point; returns whether it was inserted.
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
