//! Speeds that a scene lets expect.

use super::{Start, placed::Placed};
use crate::{
    block::uniform,
    bodies::{Block, Motion},
    formula::Formula,
};
use glam::DVec3;

/// Moments of a run at which the speed of a driven block is looked at, besides its start and its end.
const MOMENTS: u32 = 1000;

/// What makes water and blocks fast.
#[derive(Clone, Copy, Debug)]
pub(super) struct Speeds {
    gravity: DVec3,
    /// Work of gravity on a unit of mass from the origin to the top and to the bottom of the water, m²/s².
    top: f64,
    bottom: f64,
    /// The same over half a spacing of water, which is above the highest particle and below the lowest, m²/s².
    half: f64,
    /// Length of the run, s.
    length: f64,
}

impl Speeds {
    /// Those beside particles at `positions` (m), `spacing` (m) apart, in `gravity` (m/s²), at the start of a run.
    pub fn new(positions: &[DVec3], spacing: f64, gravity: DVec3) -> Self {
        let depths = positions.iter().map(|x| x.dot(gravity));
        let nothing = (f64::INFINITY, f64::NEG_INFINITY);
        let (low, high) = depths.fold(nothing, |(low, high), at| (low.min(at), high.max(at)));
        let half = 0.5 * spacing * gravity.length();
        Self {
            gravity,
            top: low - half,
            bottom: high + half,
            half,
            length: 0.0,
        }
    }

    /// The same in a run of `length` (s).
    pub fn over(self, length: f64) -> Self {
        Self { length, ..self }
    }

    /// After a fall through the height of all water, m/s.
    pub fn of_water(&self) -> f64 {
        (2.0 * (self.bottom - self.top).max(0.0)).sqrt()
    }

    /// The largest of water that starts so, m/s: after a fall from where it is to its bottom.
    pub fn of_start(&self, start: &Start) -> f64 {
        let fallen = |(x, v): (&DVec3, &DVec3)| {
            let top = x.dot(self.gravity) - self.half;
            (v.length_squared() + 2.0 * (self.bottom - top).max(0.0)).sqrt()
        };
        let all = start.positions.iter().zip(&start.velocities);
        all.map(fallen).fold(self.of_water(), f64::max)
    }

    /// The largest of a block, m/s: as it is driven, or where it is free, after a fall from where it is to the bottom
    /// of the water.
    pub fn of(&self, block: &Block) -> f64 {
        let fastest =
            |velocity: DVec3, spin: DVec3| velocity.length() + spin.length() * block.shape.radius();
        match &block.motion {
            Motion::Fixed => 0.0,
            Motion::Free => {
                let start = fastest(block.velocity, block.spin);
                (start.powi(2) + 2.0 * (self.bottom - self.foot(block)).max(0.0)).sqrt()
            }
            Motion::Driven { velocity, spin } => {
                // Not evenly, or a motion whose period divides the distance would seem to stand.
                let place = |n: u32| (f64::from(n) + uniform(0, &[n.into()])) / f64::from(MOMENTS);
                let moments = [0.0, 1.0].into_iter().chain((0..MOMENTS).map(place));
                let moments = moments.map(|share| self.length * share);
                let at = |formulas: &[Formula; 3], time| {
                    DVec3::from_array([0, 1, 2].map(|axis| formulas[axis].eval_at([0.0; 3], time)))
                };
                moments
                    .map(|time| fastest(at(velocity, time), at(spin, time)))
                    .fold(0.0, f64::max)
            }
        }
    }

    /// Work of gravity from the origin to the lowest point of a block, m²/s².
    fn foot(&self, block: &Block) -> f64 {
        let of_part = |part: &Placed<'_>| {
            let ends = (part.low * self.gravity).max(part.high * self.gravity);
            ends.element_sum()
        };
        let parts = Placed::of(block);
        parts.iter().map(of_part).fold(f64::NEG_INFINITY, f64::max)
    }
}
