//! The lattice on which particles start, and the box around it.

use super::placed::Placed;
use crate::{
    block::{HalfSpace, uniform},
    bodies::Block,
    scene::{Boundary, Face, Particles, Scene},
};
use glam::DVec3;

/// Points (i + ½) Δx from the lower corner of the domain.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice {
    /// Corners of the domain, m.
    pub low: DVec3,
    pub high: DVec3,
    /// Δx, m.
    pub spacing: f64,
    /// Layers of shells.
    pub layers: u32,
    pub periodic: [bool; 3],
    /// Whether there is one row along y, in the middle.
    pub plane: bool,
}

impl Lattice {
    pub fn of(scene: &Scene, particles: &Particles) -> Self {
        let lower = [Face::XMin, Face::YMin, Face::ZMin];
        Self {
            low: DVec3::from(scene.domain.origin),
            high: DVec3::from(scene.domain.end()),
            spacing: particles.spacing,
            layers: particles.layers(),
            periodic: lower.map(|face| *scene.boundaries.face(face) == Boundary::Periodic),
            plane: particles.plane,
        }
    }

    /// Length far below the spacing and far above the rounding of a coordinate, m.
    pub fn tolerance(&self) -> f64 {
        1e-6 * self.spacing
    }

    /// How deep the layer `layer` is, m.
    pub fn depth(&self, layer: u32) -> f64 {
        (f64::from(layer) + 0.5) * self.spacing
    }

    /// A way of at most a spacing along each axis, the same for a number each time, m.
    pub fn aside(&self, number: usize) -> DVec3 {
        let way = [0, 1, 2].map(|axis| match self.is_row(axis) {
            true => 0.0,
            false => 2.0 * uniform(0, &[number as i64, axis as i64]) - 1.0,
        });
        self.spacing * DVec3::from(way)
    }

    /// Whether what spans the domain along `axis` has no ends there.
    pub fn endless(&self, axis: usize) -> bool {
        self.periodic[axis] || self.is_row(axis)
    }

    /// Whether a block that is shorter than a period reaches across its ends along `axis`.
    pub fn is_across(&self, block: &Block, axis: usize) -> bool {
        let parts = Placed::of(block);
        let low = parts.iter().map(|part| part.low[axis]);
        let high = parts.iter().map(|part| part.high[axis]);
        let low = low.fold(f64::INFINITY, f64::min);
        let high = high.fold(f64::NEG_INFINITY, f64::max);
        let is_shorter = high - low < self.high[axis] - self.low[axis];
        is_shorter && (low < self.low[axis] || high > self.high[axis])
    }

    /// A place inside the periods, m.
    pub fn wrapped(&self, mut x: DVec3) -> DVec3 {
        for axis in (0..3).filter(|axis| self.periodic[*axis]) {
            let period = self.high[axis] - self.low[axis];
            x[axis] = self.low[axis] + (x[axis] - self.low[axis]).rem_euclid(period);
        }
        x
    }

    fn is_row(&self, axis: usize) -> bool {
        self.plane && axis == 1
    }

    /// Where shells may be along `axis`: the domain, and all layers beyond ends, m.
    pub fn reach(&self, axis: usize) -> [f64; 2] {
        let beyond = match self.endless(axis) {
            true => 0.0,
            false => f64::from(self.layers) * self.spacing,
        };
        [self.low[axis] - beyond, self.high[axis] + beyond]
    }

    /// Whether shells that do not move may be at `x` (m).
    pub fn is_within(&self, x: DVec3) -> bool {
        (0..3).all(|axis| {
            let [low, high] = self.reach(axis);
            let there = x[axis] >= low && x[axis] <= high;
            there && (!self.is_row(axis) || (x[axis] - 0.5 * (low + high)).abs() < self.tolerance())
        })
    }

    /// Where shells may be along `axis`, as half-spaces.
    pub fn sides(&self, axis: usize) -> [HalfSpace; 2] {
        let [low, high] = self.reach(axis);
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

    /// The coordinates of the lattice along `axis` from `from` to `to` (m), ends included; of what spans a period, those of
    /// one.
    pub fn row(&self, axis: usize, [from, to]: [f64; 2]) -> Vec<f64> {
        if self.is_row(axis) {
            return vec![0.5 * (self.low[axis] + self.high[axis])];
        }
        let place = |x: f64| (x - self.low[axis]) / self.spacing - 0.5;
        let (first, last) = (place(from) - 1e-6, place(to) + 1e-6);
        let (mut first, mut last) = (first.ceil() as i64, last.floor() as i64);
        let period = self.high[axis] - self.low[axis];
        if self.periodic[axis] && to - from > period - self.tolerance() {
            let count = (period / self.spacing).round() as i64;
            (first, last) = (first.max(0), last.min(count - 1));
        }
        (first..=last)
            .map(|i| self.low[axis] + (i as f64 + 0.5) * self.spacing)
            .collect()
    }

    /// The same, and `end` (m) of the range where that is too far from all of them.
    pub fn row_to(&self, axis: usize, range: [f64; 2], end: f64) -> Vec<f64> {
        let mut row = self.row(axis, range);
        let near = super::crowd::NEAREST * self.spacing;
        if row.iter().all(|at| (at - end).abs() >= near) {
            row.push(end);
        }
        row
    }

    /// The same where the points go on a spacing beyond `end` (m) of the range: one more stands in the middle of
    /// what is left, where that is room for it.
    pub fn row_beside(&self, axis: usize, range: [f64; 2], end: f64) -> Vec<f64> {
        let mut row = self.row(axis, range);
        let upward = end == range[1];
        let Some(last) = (if upward { row.last() } else { row.first() }) else {
            return vec![end];
        };
        let beyond = if upward { self.spacing } else { -self.spacing };
        let middle = last.midpoint(end + beyond);
        if (middle - last).abs() >= super::crowd::NEAREST * self.spacing {
            row.push(middle);
        }
        row
    }

    /// About as many coordinates as the spacing asks for from `from` to `to` (m), those two included.
    pub fn fitted(&self, [from, to]: [f64; 2]) -> Vec<f64> {
        let length = to - from;
        // One interval from the length on at which two points may stand.
        let mut count = (length / self.spacing).round();
        if count == 1.0 && length < super::crowd::NEAREST * self.spacing {
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
