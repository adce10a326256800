//! The flow at the time 0.

use std::fmt;

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::{Deserializer, Visitor};

use super::Scene;
use super::rules::{finite_constants, no_time};
use crate::formula::Formula;

/// Keyword for the pressure of a fluid at rest under the acceleration.
const HYDROSTATIC: &str = "hydrostatic";

/// Velocity and pressure at the time 0.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct Initial {
    /// Velocity, m/s: three numbers or formulas of x, y, z. Default at rest.
    pub velocity: [Formula; 3],
    /// Pressure above the reference pressure, Pa: `hydrostatic`, a number or a formula of x, y,
    /// z. Default `hydrostatic`.
    pub pressure: InitialPressure,
}

/// Pressure at the time 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum InitialPressure {
    /// Balances the constant acceleration along the axes that are not periodic. It is 0 on the
    /// face from which the acceleration points away, or the given pressure at the centre of the
    /// first pressure face.
    #[default]
    Hydrostatic,
    /// The given value, Pa.
    Given(Formula),
}

impl<'de> Deserialize<'de> for InitialPressure {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(WordOrFormula)
    }
}

struct WordOrFormula;

impl Visitor<'_> for WordOrFormula {
    type Value = InitialPressure;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\"{HYDROSTATIC}\", a number or a formula in quotes")
    }

    fn visit_f64<E>(self, value: f64) -> Result<InitialPressure, E> {
        Ok(InitialPressure::Given(value.into()))
    }

    fn visit_i64<E>(self, value: i64) -> Result<InitialPressure, E> {
        Ok(InitialPressure::Given((value as f64).into()))
    }

    fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<InitialPressure, E> {
        if text == HYDROSTATIC {
            return Ok(InitialPressure::Hydrostatic);
        }
        let formula = text.parse().map_err(|e| {
            E::custom(format!(
                "{e}; a pressure is \"{HYDROSTATIC}\", a number or a formula"
            ))
        })?;
        Ok(InitialPressure::Given(formula))
    }
}

impl JsonSchema for InitialPressure {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "InitialPressure".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "description": "`hydrostatic`, a number (Pa), or a formula of x, y, z (m).",
            "type": ["number", "string"]
        })
    }
}

impl Scene {
    pub(super) fn check_initial(&self) -> crate::error::Result<()> {
        no_time("initial.velocity", &self.initial.velocity)?;
        finite_constants("initial.velocity", &self.initial.velocity)?;
        match &self.initial.pressure {
            InitialPressure::Hydrostatic => Ok(()),
            InitialPressure::Given(formula) => {
                no_time("initial.pressure", std::slice::from_ref(formula))?;
                finite_constants("initial.pressure", std::slice::from_ref(formula))
            }
        }
    }
}
