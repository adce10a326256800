//! Blocks in critical positions: each scene runs, or ends with an error that says what to change.

use super::{Cell, Map, Outcome, Sink};
use crate::validate::{CaseContext, tank::Tank};
use riprap::scene::Scene;
use serde::Deserialize;
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

/// Contents of `places.toml`.
#[derive(Deserialize)]
struct Places {
    /// Tables shared by all scenes.
    scene: toml::Table,
    /// Boundary conditions, by name.
    faces: toml::Table,
    places: Vec<Place>,
}

/// Blocks, and the words that an error of their scene must contain if it ends with one.
#[derive(Deserialize)]
struct Place {
    name: String,
    faces: String,
    named: Vec<String>,
    blocks: toml::Value,
}

fn places() -> anyhow::Result<Places> {
    Ok(toml::from_str(include_str!("places.toml"))?)
}

fn run(context: &CaseContext, sink: &mut Sink) -> anyhow::Result<()> {
    let steps = if context.full { 5000 } else { 300 };
    let all = places()?;
    for place in &all.places {
        sink.add(measure(context, place, &all, steps)?)?;
    }
    Ok(())
}

impl Place {
    fn scene(&self, shared: &Places) -> riprap::Result<Scene> {
        let mut table = shared.scene.clone();
        table.insert("boundaries".into(), shared.faces[&self.faces].clone());
        table.insert("blocks".into(), self.blocks.clone());
        Scene::from_toml(&table.to_string(), Path::new("."), "stress")
    }

    /// Marks an error as unclear if its message lacks one of these words.
    fn judge(&self, cell: &mut Cell) {
        let silent = self.named.iter().any(|word| !cell.detail.contains(word));
        if let (Outcome::Error(name), true) = (&cell.outcome, silent) {
            cell.outcome = Outcome::Unclear(name.clone());
        }
    }
}

fn measure(context: &CaseContext, place: &Place, all: &Places, steps: u64) -> anyhow::Result<Cell> {
    let (y, x) = (place.name.clone(), "outcome".into());
    let cell = Cell::new(MAP.name, "", y, x, "steps until the error");
    let mut cell = cell.run(|cell| {
        let mut tank = Tank::fill(context, &place.scene(all)?)?;
        cell.warned = super::warned(tank.simulation.advice());
        while tank.simulation.step() < steps {
            let done = tank.advance(50);
            cell.steps = tank.simulation.step();
            done?;
        }
        Ok(())
    })?;
    place.judge(&mut cell);
    // A failure caused by the initial position of a block must be announced before the run; the library cannot know of later
    // ones.
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
        let all = places().unwrap();
        for place in &all.places {
            let scene = place.scene(&all);
            assert!(scene.is_ok(), "{}: {}", place.name, scene.unwrap_err());
        }
    }

    #[test]
    fn a_message_without_the_block_is_unclear() {
        let judged = |message: &str| {
            let mut cell = Cell::new("a", "", String::new(), String::new(), "");
            cell.end(Err(Error::scene("domain", message).into()))
                .unwrap();
            places().unwrap().places[1].judge(&mut cell);
            cell.outcome
        };
        assert_eq!(judged("first is wrong"), Outcome::Unclear("Scene".into()));
        assert_eq!(
            judged("first, second: relax"),
            Outcome::Error("Scene".into())
        );
    }
}
