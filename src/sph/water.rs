//! The state of the fluid particles in SI units, its totals, and the point cloud for files.

use super::{CellGrid, Particle, Setup};
use glam::{DVec3, Vec3};

/// Fluid particles inside the domain, sorted by id.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Water {
    /// Index of each particle at the start.
    pub ids: Vec<u32>,
    /// Positions, m.
    pub positions: Vec<DVec3>,
    /// Velocities, m/s.
    pub velocities: Vec<Vec3>,
    /// Densities, kg/m³.
    pub densities: Vec<f64>,
    /// Pressures, Pa.
    pub pressures: Vec<f64>,
    /// Totals of the escaped particles, each in its state at the time of escape.
    pub escaped: Totals,
}

impl Water {
    pub(super) fn of(setup: &Setup, grid: &CellGrid, particles: &[Particle]) -> Self {
        let mut all: Vec<&Particle> = particles.iter().collect();
        all.sort_unstable_by_key(|particle| particle.id);
        let mut water = Self::default();
        for particle in all {
            let excess = f64::from(particle.excess);
            let [x, y, z] = particle.at;
            let has_escaped = x < 0;
            let mut position = grid.position([if has_escaped { -1 - x } else { x }, y, z]);
            if setup.plane {
                position.y = setup.origin.y + 0.5 * setup.size.y;
            }
            let velocity = Vec3::from(particle.velocity).as_dvec3() * setup.sound_speed;
            if has_escaped {
                water.escaped.add(setup, position, velocity, excess);
                continue;
            }
            water.ids.push(particle.id);
            water.positions.push(position);
            water.velocities.push(velocity.as_vec3());
            water.densities.push(setup.density * (1.0 + excess));
            water.pressures.push(setup.pressure(excess));
        }
        water
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there are no particles.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }
}

/// Sums over fluid particles, SI.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Totals {
    /// Mass, kg.
    pub mass: f64,
    /// Momentum, kg m/s.
    pub momentum: [f64; 3],
    /// Kinetic energy, J.
    pub kinetic_energy: f64,
    /// Potential energy in gravity relative to the origin, J.
    pub potential_energy: f64,
    /// Compression energy, ∫ p/ρ² dρ from the reference density, J.
    pub compression_energy: f64,
    /// Largest speed, m/s.
    pub max_speed: f64,
}

impl Totals {
    /// Sums over `water`.
    pub fn of(setup: &Setup, water: &Water) -> Self {
        let mut totals = Self::default();
        let states = water.velocities.iter().zip(&water.densities);
        for (x, (v, density)) in water.positions.iter().zip(states) {
            totals.add(setup, *x, v.as_dvec3(), density / setup.density - 1.0);
        }
        totals
    }

    /// Adds a particle at `x` (m) with the velocity `v` (m/s) and the density excess ρ/ρ₀ − 1.
    fn add(&mut self, setup: &Setup, x: DVec3, v: DVec3, excess: f64) {
        let mass = setup.particle_mass();
        self.mass += mass;
        self.momentum = (DVec3::from(self.momentum) + mass * v).to_array();
        self.kinetic_energy += 0.5 * mass * v.length_squared();
        self.potential_energy -= mass * setup.gravity.dot(x);
        self.compression_energy += mass * setup.compression(excess);
        self.max_speed = self.max_speed.max(v.length());
    }

    /// Sum of kinetic, potential and compression energy, J.
    pub fn energy(&self) -> f64 {
        self.kinetic_energy + self.potential_energy + self.compression_energy
    }
}
