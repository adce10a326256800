//! Equations of state of weakly compressible water.

use super::Setup;

/// Pressure as a function of density.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EquationOfState {
    /// p = c₀² (ρ − ρ₀).
    #[default]
    Linear,
    /// p = ρ₀ c₀²/7 ((ρ/ρ₀)⁷ − 1), Cole (1948).
    Tait,
}

impl Setup {
    /// Pressure (Pa) at the density excess ρ/ρ₀ − 1.
    pub fn pressure(&self, excess: f64) -> f64 {
        let unit = self.density * self.sound_speed.powi(2);
        match self.equation_of_state {
            EquationOfState::Linear => unit * excess,
            EquationOfState::Tait => unit * ((1.0 + excess).powi(7) - 1.0) / 7.0,
        }
    }

    /// Specific compression energy (J/kg) at the density excess ρ/ρ₀ − 1: ∫ p/ρ² dρ.
    pub fn compression(&self, excess: f64) -> f64 {
        let ratio = 1.0 + excess;
        self.sound_speed.powi(2)
            * match self.equation_of_state {
                // ln(1 + s) − s/(1 + s), whose first terms cancel.
                EquationOfState::Linear => excess.ln_1p() - excess / ratio,
                EquationOfState::Tait => (ratio.powi(6) / 6.0 + 1.0 / ratio - 7.0 / 6.0) / 7.0,
            }
    }

    /// Density excess ρ/ρ₀ − 1 at a pressure (Pa).
    pub fn excess(&self, pressure: f64) -> f64 {
        let p = pressure / (self.density * self.sound_speed.powi(2));
        match self.equation_of_state {
            EquationOfState::Linear => p,
            EquationOfState::Tait => (1.0 + 7.0 * p).powf(1.0 / 7.0) - 1.0,
        }
    }
}
