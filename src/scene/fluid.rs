//! What flows.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::formula::Formula;

/// The fluid and the body force on it. The default is none: density and viscosity 0.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fluid {
    /// Density, kg/m³. Default 1000.
    #[serde(default = "water")]
    pub density: f64,
    /// Kinematic viscosity, m²/s. Particles can do without, and then slide along walls and blocks; default 0.
    #[serde(default)]
    pub viscosity: f64,
    /// Body force per mass, m/s²: three numbers or formulas of x, y, z; for particles three
    /// numbers: their gravity. Default none.
    #[serde(default)]
    pub acceleration: [Formula; 3],
}

fn water() -> f64 {
    1000.0
}
