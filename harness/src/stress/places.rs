//! Blocks in places where something may go wrong: each runs, or ends with an error that says what to change.

use super::{Cell, Map, Outcome, Sink};
use crate::validate::{Stand, tank::Tank};
use riprap::scene::Scene;
use std::path::Path;

/// The map.
pub const MAP: Map = Map {
    name: "places",
    title: "Blocks that touch, leave, and lie across what bounds the flow",
    x: "",
    y: "",
    short: "300 steps",
    full: "5000 steps",
    run,
};

/// A scene, and what an error of it has to name if it ends with one.
struct Place {
    name: &'static str,
    /// Conditions on the faces, and gravity.
    around: &'static str,
    blocks: &'static str,
    named: &'static [&'static str],
}

const DUCT: &str = r#"
x_min = { kind = "velocity", velocity = [0.05, 0, 0] }
x_max = { kind = "pressure" }
y_min = { kind = "wall" }
y_max = { kind = "free_slip" }
"#;
const FIRM: &str = r#"
x_min = { kind = "velocity", velocity = [0.05, 0, 0] }
x_max = { kind = "pressure", reflecting = true }
"#;
/// Nothing comes in below 6.
const ABOVE: &str = r#"
x_min = { kind = "velocity", velocity = ["0.05*min(1, max(0, y - 6))", 0, 0] }
x_max = { kind = "pressure" }
y_min = { kind = "wall" }
y_max = { kind = "free_slip" }
"#;
const PERIODIC: &str = "";

const PLACES: &[Place] = &[
    Place {
        name: "two blocks touch",
        around: PERIODIC,
        blocks: r#"{ name = "a", kind = "box", size = [5, 5, 5], position = [12, 8, 8], velocity = [0.02, 0, 0] },
                   { name = "b", kind = "box", size = [5, 5, 5], position = [17, 8, 8] }"#,
        named: &["a", "b"],
    },
    Place {
        name: "two blocks overlap",
        around: PERIODIC,
        blocks: r#"{ name = "first", kind = "box", size = [5, 5, 5], position = [12, 8, 8] },
                   { name = "second", kind = "box", size = [5, 5, 5], position = [16, 8, 8] }"#,
        named: &["first", "second", "relax"],
    },
    Place {
        name: "leaves, pressure face",
        around: DUCT,
        blocks: r#"{ name = "out", kind = "box", size = [5, 5, 5], position = [28, 8, 8], velocity = [0.05, 0, 0] }"#,
        named: &["out", "x_max"],
    },
    Place {
        name: "leaves, reflecting face",
        around: FIRM,
        blocks: r#"{ name = "out", kind = "box", size = [5, 5, 5], position = [28, 8, 8], velocity = [0.05, 0, 0] }"#,
        named: &["out", "x_max"],
    },
    Place {
        name: "fixed across the outlet",
        around: DUCT,
        blocks: r#"{ name = "pier", kind = "box", size = [6, 6, 6], position = [31, 8, 8], motion = "fixed" }"#,
        named: &["pier", "x_max"],
    },
    Place {
        name: "at a wall",
        around: DUCT,
        blocks: r#"{ name = "low", kind = "box", size = [5, 5, 5], position = [12, 2.5, 8] }"#,
        named: &["low", "wall_y_min"],
    },
    Place {
        name: "pressed against a wall",
        around: DUCT,
        blocks: r#"{ name = "low", kind = "box", size = [5, 5, 5], position = [12, 3, 8],
                   acceleration = [0, -1e-3, 0] }"#,
        named: &["low", "wall_y_min"],
    },
    Place {
        name: "starts in a wall",
        around: DUCT,
        blocks: r#"{ name = "deep", kind = "box", size = [5, 5, 5], position = [12, 1.5, 8] }"#,
        named: &["deep", "wall_y_min"],
    },
    Place {
        name: "across a periodic border",
        around: PERIODIC,
        blocks: r#"{ name = "edge", kind = "box", size = [5, 5, 5], position = [31.5, 8, 8], velocity = [0.05, 0, 0] }"#,
        named: &["edge"],
    },
    Place {
        name: "across three periodic borders",
        around: PERIODIC,
        blocks: r#"{ name = "corner", kind = "sphere", radius = 3, position = [0.2, 0.1, 15.9],
                   velocity = [-0.03, -0.03, 0.03] }"#,
        named: &["corner"],
    },
    Place {
        name: "meet across a periodic border",
        around: PERIODIC,
        blocks: r#"{ name = "left", kind = "box", size = [5, 5, 5], position = [3, 8, 8], velocity = [-0.04, 0, 0] },
                   { name = "right", kind = "box", size = [5, 5, 5], position = [29, 8, 8], velocity = [0.04, 0, 0] }"#,
        named: &["left", "right"],
    },
    Place {
        name: "fixed across the inlet",
        around: DUCT,
        blocks: r#"{ name = "pier", kind = "box", size = [6, 6, 6], position = [1, 8, 8], motion = "fixed" }"#,
        named: &["pier", "x_min", "cell"],
    },
    Place {
        name: "closes the inlet",
        around: DUCT,
        blocks: r#"{ name = "plug", kind = "box", size = [6, 16, 16], position = [1, 8, 8], motion = "fixed" }"#,
        named: &["plug", "x_min", "cell"],
    },
    Place {
        name: "free across the inlet",
        around: DUCT,
        blocks: r#"{ name = "boulder", kind = "box", size = [5, 5, 5], position = [1, 8, 8] }"#,
        named: &["boulder", "x_min", "cell"],
    },
    Place {
        name: "driven into the inlet",
        around: DUCT,
        blocks: r#"{ name = "ram", kind = "box", size = [5, 5, 5], position = [8, 8, 8], motion = "driven",
                   velocity = [-0.03, 0, 0] }"#,
        named: &["ram", "x_min", "cell"],
    },
    Place {
        name: "across the inlet, no flow there",
        around: ABOVE,
        blocks: r#"{ name = "bed", kind = "box", size = [48, 5, 20], position = [16, 2.5, 8], motion = "fixed" }"#,
        named: &["bed", "x_min", "cell"],
    },
];

fn run(stand: &Stand, sink: &mut Sink) -> anyhow::Result<()> {
    let steps = if stand.full { 5000 } else { 300 };
    for place in PLACES {
        sink.add(measure(stand, place, steps)?)?;
    }
    Ok(())
}

impl Place {
    fn text(&self) -> String {
        format!(
            r#"
            blocks = [{}]
            [domain]
            size = [32, 16, 16]
            cell = 1
            [fluid]
            density = 1
            viscosity = 0.02
            [numerics]
            time_step = 1
            velocity_scale = 0.06
            [initial]
            velocity = [0.05, 0, 0]
            [rock]
            gravity = [0, 0, 0]
            [run]
            steps = 1
            [boundaries]
            {}
            [[materials]]
            name = "rock"
            density = 2.65
            normal_stiffness = 0.5
            friction = 30
            damping = 0.3
            "#,
            self.blocks.replace('\n', " "),
            self.around
        )
    }

    /// Whether an error says where.
    fn judge(&self, cell: &mut Cell) {
        let silent = self.named.iter().any(|word| !cell.detail.contains(word));
        if let (Outcome::Error(name), true) = (&cell.outcome, silent) {
            cell.outcome = Outcome::Unclear(name.clone());
        }
    }
}

fn measure(stand: &Stand, place: &Place, steps: u64) -> anyhow::Result<Cell> {
    let (y, x) = (place.name.into(), "outcome".into());
    let cell = Cell::new(MAP.name, "", y, x, "steps until the error");
    let mut cell = cell.run(|cell| {
        let scene = Scene::from_toml(&place.text(), Path::new("."), "stress")?;
        let mut tank = Tank::fill(stand, &scene)?;
        cell.warned = super::warned(tank.simulation.advice());
        while tank.simulation.step() < steps {
            let done = tank.advance(50);
            cell.steps = tank.simulation.step();
            done?;
        }
        Ok(())
    })?;
    place.judge(&mut cell);
    // What will end badly because of where a block is at the start is to be told before; of what comes later, the
    // library does not know.
    let told = cell.steps == 0 || cell.warned.contains("boundaries");
    cell.agrees = Some(cell.outcome.is_good() || told || place.name.starts_with("driven"));
    Ok(cell)
}

#[cfg(test)]
mod tests {
    use super::*;
    use riprap::Error;

    #[test]
    fn all_places_are_scenes() {
        for place in PLACES {
            let scene = Scene::from_toml(&place.text(), Path::new("."), "stress");
            assert!(scene.is_ok(), "{}: {}", place.name, scene.unwrap_err());
        }
    }

    #[test]
    fn a_message_without_the_block_is_unclear() {
        let judged = |message: &str| {
            let mut cell = Cell::new("a", "", String::new(), String::new(), "");
            cell.end(Err(Error::scene("domain", message).into()))
                .unwrap();
            PLACES[1].judge(&mut cell);
            cell.outcome
        };
        assert_eq!(judged("first is wrong"), Outcome::Unclear("Scene".into()));
        assert_eq!(
            judged("first, second: relax"),
            Outcome::Error("Scene".into())
        );
    }
}
