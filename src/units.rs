//! The border between SI and lattice units.
//!
//! In lattice units a cell, a time step and the reference density are 1. Everything outside the
//! kernels is in SI; what crosses the border passes through a function of [`Units`].

use crate::error::{Error, Result};

/// Squared speed of sound of the lattice, lattice units.
pub const SOUND_SPEED_SQUARED: f64 = 1.0 / 3.0;

/// What one lattice unit of length, time and density is in SI.
///
/// ```
/// let units = riprap::units::Units { cell: 0.01, time_step: 0.001, density: 1000.0 };
/// assert_eq!(units.velocity_from_lattice(0.05), 0.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// Edge of a cell Δx, m.
    pub cell: f64,
    /// Time step Δt, s.
    pub time_step: f64,
    /// Reference density ρ₀, kg/m³.
    pub density: f64,
}

impl Units {
    /// Whether all of them are positive numbers.
    ///
    /// # Errors
    /// [`Error::Argument`] naming the first that is not.
    pub fn check(&self) -> Result<()> {
        let all = [
            ("cell", self.cell),
            ("time_step", self.time_step),
            ("density", self.density),
        ];
        match all
            .iter()
            .find(|(_, unit)| !(*unit > 0.0 && unit.is_finite()))
        {
            None => Ok(()),
            Some((name, unit)) => {
                let message = format!("is {unit}; give a number greater than 0");
                Err(Error::argument(format!("units.{name}"), message))
            }
        }
    }

    /// m/s of the lattice velocity 1.
    fn velocity(&self) -> f64 {
        self.cell / self.time_step
    }

    /// N of the lattice force 1.
    fn force(&self) -> f64 {
        self.density * self.velocity().powi(2) * self.cell.powi(2)
    }

    /// m/s → lattice.
    pub fn velocity_to_lattice(&self, velocity: f64) -> f64 {
        velocity / self.velocity()
    }

    /// Lattice → m/s.
    pub fn velocity_from_lattice(&self, velocity: f64) -> f64 {
        velocity * self.velocity()
    }

    /// Pressure above the reference pressure, Pa → lattice density ρ, which is 1 at rest.
    pub fn pressure_to_lattice(&self, pressure: f64) -> f64 {
        1.0 + pressure / (self.density * SOUND_SPEED_SQUARED * self.velocity().powi(2))
    }

    /// Lattice density ρ → pressure above the reference pressure, Pa: ρ₀ c_s² (ρ − 1) Δx²/Δt².
    pub fn pressure_from_lattice(&self, rho: f64) -> f64 {
        self.density * SOUND_SPEED_SQUARED * (rho - 1.0) * self.velocity().powi(2)
    }

    /// Lattice → Pa, of a stress: ρ₀ Δx²/Δt².
    pub fn stress_from_lattice(&self, stress: f64) -> f64 {
        self.density * stress * self.velocity().powi(2)
    }

    /// kg/m³ → lattice.
    pub fn density_to_lattice(&self, density: f64) -> f64 {
        density / self.density
    }

    /// Lattice → kg/m³.
    pub fn density_from_lattice(&self, rho: f64) -> f64 {
        rho * self.density
    }

    /// N → lattice.
    pub fn force_to_lattice(&self, force: f64) -> f64 {
        force / self.force()
    }

    /// Lattice → N: ρ₀ Δx⁴/Δt².
    pub fn force_from_lattice(&self, force: f64) -> f64 {
        force * self.force()
    }

    /// N m → lattice.
    pub fn torque_to_lattice(&self, torque: f64) -> f64 {
        torque / (self.force() * self.cell)
    }

    /// Lattice → N m: ρ₀ Δx⁵/Δt².
    pub fn torque_from_lattice(&self, torque: f64) -> f64 {
        torque * self.force() * self.cell
    }

    /// m/s² → lattice.
    pub fn acceleration_to_lattice(&self, acceleration: f64) -> f64 {
        acceleration * self.time_step / self.velocity()
    }

    /// Lattice → m/s².
    pub fn acceleration_from_lattice(&self, acceleration: f64) -> f64 {
        acceleration * self.velocity() / self.time_step
    }

    /// m²/s → lattice.
    pub fn viscosity_to_lattice(&self, viscosity: f64) -> f64 {
        viscosity / (self.velocity() * self.cell)
    }

    /// Lattice → m²/s.
    pub fn viscosity_from_lattice(&self, viscosity: f64) -> f64 {
        viscosity * self.velocity() * self.cell
    }

    /// 1/s (vorticity, rate of strain) → lattice.
    pub fn rate_to_lattice(&self, rate: f64) -> f64 {
        rate * self.time_step
    }

    /// Lattice → 1/s.
    pub fn rate_from_lattice(&self, rate: f64) -> f64 {
        rate / self.time_step
    }

    /// s → time steps, not rounded.
    pub fn time_to_lattice(&self, time: f64) -> f64 {
        time / self.time_step
    }

    /// Time steps → s.
    pub fn time_from_lattice(&self, steps: f64) -> f64 {
        steps * self.time_step
    }

    /// The nearest whole number of time steps in `time` s, at least 1.
    pub fn steps(&self, time: f64) -> u64 {
        (time / self.time_step).round().max(1.0) as u64
    }

    /// Relaxation time τ = ½ + ν/c_s² of the kinematic viscosity `viscosity` in m²/s, lattice
    /// units.
    pub fn tau(&self, viscosity: f64) -> f64 {
        0.5 + self.viscosity_to_lattice(viscosity) / SOUND_SPEED_SQUARED
    }

    /// Mach number of the lattice at the speed `speed` in m/s.
    pub fn mach(&self, speed: f64) -> f64 {
        self.velocity_to_lattice(speed) / SOUND_SPEED_SQUARED.sqrt()
    }
}
