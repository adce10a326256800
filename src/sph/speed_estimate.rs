//! Estimates of the largest speeds in a scene.

use super::{Start, solid::ConvexPart};
use crate::{
    geometry::min_max,
    random::uniform,
    rock::{Block, Motion, formula_values},
};
use glam::DVec3;

/// Number of times at which the speed of a driven block is sampled, in addition to the start and the end of the run.
const SAMPLES: u32 = 1000;

/// Energies and times that determine the speeds of water and blocks.
#[derive(Clone, Copy, Debug)]
pub struct SpeedEstimate {
    gravity: DVec3,
    /// Work of gravity per unit mass from the origin to the top and to the bottom of the water, m²/s².
    top: f64,
    bottom: f64,
    /// Work of gravity per unit mass over the half spacing of water beyond the outermost particles, m²/s².
    half: f64,
    /// Length of the run, s.
    length: f64,
}

impl SpeedEstimate {
    /// The estimate for particles at `positions` (m), `spacing` (m) apart, in `gravity` (m/s²), at the start of a run.
    pub fn new(positions: &[DVec3], spacing: f64, gravity: DVec3) -> Self {
        let [low, high] = min_max(positions.iter().map(|x| x.dot(gravity)));
        let half = 0.5 * spacing * gravity.length();
        Self {
            gravity,
            top: low - half,
            bottom: high + half,
            half,
            length: 0.0,
        }
    }

    /// The estimate for a run of `length` (s).
    pub fn over(self, length: f64) -> Self {
        Self { length, ..self }
    }

    /// Speed after a fall through the depth of all water, m/s.
    pub fn of_water(&self) -> f64 {
        (2.0 * (self.bottom - self.top).max(0.0)).sqrt()
    }

    /// Largest speed of a particle after a fall from its initial position to the bottom of the water, m/s.
    pub fn of_start(&self, start: &Start) -> f64 {
        let fallen = |(x, v): (&DVec3, &DVec3)| {
            let top = x.dot(self.gravity) - self.half;
            (v.length_squared() + 2.0 * (self.bottom - top).max(0.0)).sqrt()
        };
        let all = start.positions.iter().zip(&start.velocities);
        all.map(fallen).fold(self.of_water(), f64::max)
    }

    /// Largest speed of a block, m/s: the prescribed one if it is driven; if it is free, the speed after a fall from its
    /// initial position to the bottom of the water.
    pub fn of_block(&self, block: &Block) -> f64 {
        let fastest =
            |velocity: DVec3, spin: DVec3| velocity.length() + spin.length() * block.shape.radius();
        match &block.motion {
            Motion::Fixed => 0.0,
            Motion::Free => {
                let start = fastest(block.velocity, block.spin);
                (start.powi(2) + 2.0 * (self.bottom - self.lowest_point(block)).max(0.0)).sqrt()
            }
            Motion::Driven { velocity, spin } => {
                // The samples are jittered: at even intervals a periodic motion could appear to be at rest.
                let jittered =
                    |n: u32| (f64::from(n) + uniform(0, &[n.into()])) / f64::from(SAMPLES);
                let times = [0.0, 1.0].into_iter().chain((0..SAMPLES).map(jittered));
                let times = times.map(|fraction| self.length * fraction);
                let speeds = times.map(|time| {
                    fastest(formula_values(velocity, time), formula_values(spin, time))
                });
                speeds.fold(0.0, f64::max)
            }
        }
    }

    /// Work of gravity per unit mass from the origin to the lowest point of a block, m²/s².
    fn lowest_point(&self, block: &Block) -> f64 {
        let of_part = |part: &ConvexPart<'_>| {
            let ends = (part.low * self.gravity).max(part.high * self.gravity);
            ends.element_sum()
        };
        let parts = ConvexPart::of_block(block);
        parts.iter().map(of_part).fold(f64::NEG_INFINITY, f64::max)
    }
}
