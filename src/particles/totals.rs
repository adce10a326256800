//! What sums up all particles.

use super::{Setup, Water};
use glam::DVec3;

/// Sums over all particles of water, SI.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Totals {
    /// Mass, kg.
    pub mass: f64,
    /// Momentum, kg m/s.
    pub momentum: [f64; 3],
    /// Kinetic energy, J.
    pub kinetic_energy: f64,
    /// Potential energy in gravity, against that of all of it at the origin, J.
    pub potential_energy: f64,
    /// Largest speed, m/s.
    pub max_speed: f64,
}

impl Totals {
    /// Those of `water`.
    pub fn of(setup: &Setup, water: &Water) -> Self {
        let each = setup.particle_mass();
        let mut totals = Self {
            mass: each * water.len() as f64,
            ..Self::default()
        };
        let mut momentum = DVec3::ZERO;
        for (x, v) in water.positions.iter().zip(&water.velocities) {
            let v = v.as_dvec3();
            momentum += each * v;
            totals.kinetic_energy += 0.5 * each * v.length_squared();
            totals.potential_energy -= each * setup.gravity.dot(*x);
            totals.max_speed = totals.max_speed.max(v.length());
        }
        totals.momentum = momentum.to_array();
        totals
    }
}
