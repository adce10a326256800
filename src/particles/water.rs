//! The state of the water as others see it, SI.

use super::{Frame, Particle, Setup, StateEquation, Totals};
use glam::{DVec3, Vec3};

/// Particles of water that have not left, by their ids.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Water {
    /// Number that each had at the start.
    pub ids: Vec<u32>,
    /// m.
    pub positions: Vec<DVec3>,
    /// m/s.
    pub velocities: Vec<Vec3>,
    /// kg/m³.
    pub densities: Vec<f64>,
    /// Pa.
    pub pressures: Vec<f64>,
    /// What those have taken along that have left, as they were then.
    pub left: Totals,
}

impl Water {
    pub(super) fn of(setup: &Setup, frame: &Frame, particles: &[Particle]) -> Self {
        let mut all: Vec<&Particle> = particles.iter().collect();
        all.sort_unstable_by_key(|particle| particle.id);
        let mut water = Self::default();
        for particle in all {
            let excess = f64::from(particle.excess);
            let [x, y, z] = particle.at;
            let has_left = x < 0;
            let mut position = frame.position([if has_left { -1 - x } else { x }, y, z]);
            if setup.plane {
                position.y = setup.origin.y + 0.5 * setup.size.y;
            }
            let velocity = Vec3::from(particle.velocity).as_dvec3() * setup.sound_speed;
            if has_left {
                water.left.add(setup, position, velocity, excess);
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

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }
}

impl Setup {
    /// Pressure (Pa) at a density that is higher than the reference density by the part `excess` of it.
    pub fn pressure(&self, excess: f64) -> f64 {
        let unit = self.density * self.sound_speed.powi(2);
        match self.state {
            StateEquation::Linear => unit * excess,
            StateEquation::Tait => unit * ((1.0 + excess).powi(7) - 1.0) / 7.0,
        }
    }

    /// Energy of compression of a kilogram, J, at a density that is higher than the reference density by the part
    /// `excess` of it: ∫ p/ρ² dρ.
    pub fn compression(&self, excess: f64) -> f64 {
        let ratio = 1.0 + excess;
        self.sound_speed.powi(2)
            * match self.state {
                // ln(1 + s) − s/(1 + s), whose first terms cancel.
                StateEquation::Linear => excess.ln_1p() - excess / ratio,
                StateEquation::Tait => (ratio.powi(6) / 6.0 + 1.0 / ratio - 7.0 / 6.0) / 7.0,
            }
    }

    /// The density excess, in parts of the reference density, at a pressure (Pa).
    pub fn excess(&self, pressure: f64) -> f64 {
        let p = pressure / (self.density * self.sound_speed.powi(2));
        match self.state {
            StateEquation::Linear => p,
            StateEquation::Tait => (1.0 + 7.0 * p).powf(1.0 / 7.0) - 1.0,
        }
    }
}
