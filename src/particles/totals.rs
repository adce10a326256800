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
    /// Energy of compression, ∫ p/ρ² dρ from the reference density, J.
    pub compression_energy: f64,
    /// Largest speed, m/s.
    pub max_speed: f64,
}

impl Totals {
    /// Those of `water`.
    pub fn of(setup: &Setup, water: &Water) -> Self {
        let mut totals = Self::default();
        let states = water.velocities.iter().zip(&water.densities);
        for (x, (v, density)) in water.positions.iter().zip(states) {
            totals.add(setup, *x, v.as_dvec3(), density / setup.density - 1.0);
        }
        totals
    }

    /// Adds a particle at `x` (m) with the velocity `v` (m/s), its density `excess` parts above the reference density.
    pub(super) fn add(&mut self, setup: &Setup, x: DVec3, v: DVec3, excess: f64) {
        let each = setup.particle_mass();
        self.mass += each;
        self.momentum = (DVec3::from(self.momentum) + each * v).to_array();
        self.kinetic_energy += 0.5 * each * v.length_squared();
        self.potential_energy -= each * setup.gravity.dot(x);
        self.compression_energy += each * setup.compression(excess);
        self.max_speed = self.max_speed.max(v.length());
    }

    /// Kinetic, potential and compression energy, J.
    pub fn energy(&self) -> f64 {
        self.kinetic_energy + self.potential_energy + self.compression_energy
    }
}
