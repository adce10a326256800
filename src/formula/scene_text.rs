//! Deserialization and JSON schema of formulas in scenes.

use super::Formula;
use serde::de::{Deserialize, Deserializer, Visitor};
use std::fmt;

impl<'de> Deserialize<'de> for Formula {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumberOrText)
    }
}

struct NumberOrText;

impl Visitor<'_> for NumberOrText {
    type Value = Formula;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number or a formula in quotes")
    }

    fn visit_f64<E>(self, value: f64) -> Result<Formula, E> {
        Ok(Formula::number(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Formula, E> {
        Ok(Formula::number(value as f64))
    }

    fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<Formula, E> {
        text.parse().map_err(E::custom)
    }
}

impl schemars::JsonSchema for Formula {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Formula".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "description": "A number, or a formula of x, y, z (m) and, where the key allows it, t (s).",
            "type": ["number", "string"]
        })
    }
}
