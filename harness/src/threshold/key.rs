//! A number or a formula in a scene, addressed by its key.

use riprap::{Error, Result, formula::Formula};
use toml::{Table, Value};

/// A key such as `boundaries.x_min.velocity[0]` or `blocks[1].position[2]`.
#[derive(Clone, Debug)]
pub struct Key {
    text: String,
    steps: Vec<Step>,
}

#[derive(Clone, Debug)]
enum Step {
    Name(String),
    Index(usize),
}

/// Keys of velocities, with the squares of which loads grow.
const VELOCITIES: [&str; 3] = ["velocity", "bulk_velocity", "speed"];

/// Whether the text at this key is a name or a word, which may look like a formula: `x`.
fn names(step: &Step) -> bool {
    const NAMES: [&str; 6] = ["name", "axis", "kind", "block", "material", "title"];
    matches!(step, Step::Name(name) if NAMES.contains(&name.as_str()))
}

impl Key {
    /// Parses a key.
    pub fn parse(text: &str) -> Result<Self> {
        let wrong = || {
            let message = format!(
                "`{text}` is no place in a scene; write names with dots between them and numbers from 0 in \
                 brackets, such as boundaries.x_min.velocity[0]"
            );
            Error::argument("--key", message)
        };
        let mut steps = Vec::new();
        for part in text.split('.') {
            let mut pieces = part.split('[');
            let name = pieces.next().filter(|name| !name.is_empty());
            steps.push(Step::Name(name.ok_or_else(wrong)?.trim().into()));
            for index in pieces {
                let index = index.strip_suffix(']').and_then(|i| i.parse().ok());
                steps.push(Step::Index(index.ok_or_else(wrong)?));
            }
        }
        Ok(Self {
            text: text.into(),
            steps,
        })
    }

    /// The first name of the key.
    pub fn section(&self) -> &str {
        match self.steps.first() {
            Some(Step::Name(name)) => name,
            _ => "",
        }
    }

    /// Refuses a key whose value the loads of the flow do not grow with the square of.
    pub fn check_velocity(&self) -> Result<()> {
        let is_velocity = |step: &Step| match step {
            Step::Name(name) => VELOCITIES.contains(&name.as_str()),
            Step::Index(_) => false,
        };
        if self.steps.iter().any(is_velocity) {
            return Ok(());
        }
        let message = format!(
            "loads are scaled with the square of a velocity, and `{}` is none; remove --equilibrium, or vary a key such as \
             boundaries.x_min.velocity[0]",
            self.text
        );
        Err(Error::argument("--equilibrium", message))
    }

    /// Sets the number in the scene to a value, or multiplies the formula that is there by it. A number that a table does not
    /// have yet is added.
    pub fn set(&self, scene: &mut Table, value: f64) -> Result<()> {
        let Some((last, way)) = self.steps.split_last() else {
            return Ok(());
        };
        let [Step::Name(first), way @ ..] = way else {
            let has = scene.keys().cloned().collect::<Vec<_>>().join(", ");
            return Err(self.wrong(format!("it names a table, or nothing; the scene has {has}")));
        };
        let mut at = scene
            .get_mut(first)
            .ok_or_else(|| self.wrong(format!("the scene has no `{first}`")))?;
        for step in way {
            at = self.enter(at, step)?;
        }
        match (last, at) {
            (Step::Name(name), Value::Table(table)) if !table.contains_key(name) => {
                table.insert(name.clone(), Value::Float(value));
                Ok(())
            }
            (last, at) => {
                let number = self.enter(at, last)?;
                *number = match number {
                    Value::Integer(_) | Value::Float(_) => Value::Float(value),
                    Value::String(text) if !names(last) && text.parse::<Formula>().is_ok() => {
                        Value::String(format!("({value})*({text})"))
                    }
                    other => {
                        let message = format!("it is {other}, and neither a number nor a formula");
                        return Err(self.wrong(message));
                    }
                };
                Ok(())
            }
        }
    }

    fn enter<'a>(&self, at: &'a mut Value, step: &Step) -> Result<&'a mut Value> {
        match (step, at) {
            (Step::Name(name), Value::Table(table)) => {
                let has = table.keys().cloned().collect::<Vec<_>>().join(", ");
                table
                    .get_mut(name)
                    .ok_or_else(|| self.wrong(format!("there is no `{name}`, but {has}")))
            }
            // An entry by its name.
            (Step::Name(name), Value::Array(array)) => array
                .iter_mut()
                .find(|entry| entry.get("name").and_then(Value::as_str) == Some(name))
                .ok_or_else(|| self.wrong(format!("no entry is called `{name}`"))),
            (Step::Index(index), Value::Array(array)) => {
                let count = array.len();
                array
                    .get_mut(*index)
                    .ok_or_else(|| self.wrong(format!("there is no [{index}] among {count}")))
            }
            (Step::Name(name), at) => {
                let message = format!("a value of type {} has no `{name}`", at.type_str());
                Err(self.wrong(message))
            }
            (Step::Index(index), at) => {
                let message = format!("a value of type {} has no [{index}]", at.type_str());
                Err(self.wrong(message))
            }
        }
    }

    fn wrong(&self, message: String) -> Error {
        Error::argument(format!("--key {}", self.text), message)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene() -> Table {
        let text = r#"
            [numerics]
            mach = 0.1
            [boundaries]
            x_min = { kind = "velocity", velocity = [1, 0.5, "1 - t"] }
            [[blocks]]
            name = "b"
            position = [[0, 1], [2, 3]]
        "#;
        toml::from_str(text).unwrap()
    }

    fn set(key: &str) -> Result<Table> {
        let mut scene = scene();
        Key::parse(key)?.set(&mut scene, 7.5)?;
        Ok(scene)
    }

    #[test]
    fn numbers_are_found_and_changed() {
        let changed = set("boundaries.x_min.velocity[0]").unwrap();
        let velocity = &changed["boundaries"]["x_min"]["velocity"];
        assert_eq!(velocity.as_array().unwrap()[0], Value::Float(7.5));
        assert_eq!(
            set("blocks.b.position[1][0]").unwrap(),
            set("blocks[0].position[1][0]").unwrap()
        );
        assert_eq!(velocity.as_array().unwrap()[1], Value::Float(0.5));
        let changed = set("blocks[0].position[1][0]").unwrap();
        let position = &changed["blocks"][0]["position"];
        assert_eq!(position[1][0], Value::Float(7.5));
        assert_eq!(position[1][1], Value::Integer(3));
        // A formula is multiplied, whatever it is and whatever the sign.
        let changed = set("boundaries.x_min.velocity[2]").unwrap();
        let velocity = &changed["boundaries"]["x_min"]["velocity"];
        assert_eq!(velocity[2].as_str(), Some("(7.5)*(1 - t)"));
        let mut scene = scene();
        let key = Key::parse("boundaries.x_min.velocity[2]").unwrap();
        key.set(&mut scene, -2.5e-9).unwrap();
        let text = scene["boundaries"]["x_min"]["velocity"][2].as_str();
        let formula: Formula = text.unwrap().parse().unwrap();
        assert_eq!(formula.eval(0.0, 0.0, 0.0, 5.0), 1e-8);
        // Keys that have a default need not be written.
        let changed = set("numerics.time_step").unwrap();
        assert_eq!(changed["numerics"]["time_step"], Value::Float(7.5));
    }

    #[test]
    fn keys_of_velocities_are_known() {
        for key in [
            "boundaries.x_min.velocity[0]",
            "fluid.bulk_velocity",
            "boundaries.x_min.inflow.speed",
        ] {
            Key::parse(key).unwrap().check_velocity().unwrap();
        }
        let other = Key::parse("materials.velocity_stone.friction").unwrap();
        let error = other.check_velocity().unwrap_err().to_string();
        assert!(
            error.contains("`materials.velocity_stone.friction` is none"),
            "{error}"
        );
    }

    #[test]
    fn places_that_are_none_are_told() {
        for (key, told) in [
            ("boundaries..velocity", "no place in a scene"),
            ("blocks[x].position", "no place in a scene"),
            ("blocks", "names a table"),
            ("fluids.viscosity", "no `fluids`"),
            ("boundaries.x_mid.velocity[0]", "no `x_mid`, but x_min"),
            ("boundaries.x_min.velocity[3]", "no [3] among 3"),
            (
                "boundaries.x_min.velocity",
                "neither a number nor a formula",
            ),
            ("boundaries.x_min.kind", "neither a number nor a formula"),
            ("blocks.stone.position[0]", "no entry is called `stone`"),
            ("numerics.mach[0]", "type float has no [0]"),
            ("numerics.mach.x", "type float has no `x`"),
        ] {
            let error = set(key).unwrap_err().to_string();
            assert!(error.contains(told), "{key}: {error}");
        }
    }
}
