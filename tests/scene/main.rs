//! The scene format: accepted and refused scenes, messages, and sampled fields.

mod blocks;
mod format;
mod formulas;
mod particles;
mod refusals;
mod sampling;
mod solid_fractions;
mod solids;
mod units;
mod warnings;

use std::path::Path;

use riprap::Result;
use riprap::scene::Scene;

/// A complete scene: a channel of 20 × 10 × 4 cells.
const CHANNEL: &str = r#"
[domain]
size = [0.02, 0.01, 0.004]
cell = 1e-3
[fluid]
viscosity = 1e-6
[run]
steps = 10
"#;

/// The text as a scene that was read from `channel.toml`.
fn read(text: &str) -> Result<Scene> {
    Scene::from_toml(text, Path::new("."), "channel.toml")
}

/// [`CHANNEL`] with more tables after it.
fn channel(more: &str) -> Result<Scene> {
    read(&format!("{CHANNEL}{more}"))
}

/// [`CHANNEL`] with a piece of its text replaced.
fn changed(from: &str, to: &str) -> Result<Scene> {
    assert!(CHANNEL.contains(from));
    read(&CHANNEL.replace(from, to))
}

/// Asserts that the error contains all of `parts`.
#[track_caller]
fn refused<T: std::fmt::Debug>(result: Result<T>, parts: &[&str]) {
    let words = result.expect_err("this must be refused").to_string();
    for part in parts {
        assert!(words.contains(part), "`{part}` is not in: {words}");
    }
}
