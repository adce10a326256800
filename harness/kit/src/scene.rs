//! Scenes that several test programs read.

use riprap::{Result, scene::Scene};
use std::path::Path;

/// Still water, 0.8 m deep, in a tank of 12 × 8 particles in which nothing varies along y.
pub const STILL_WATER: &str = r#"
    title = "still"
    [domain]
    size = [1.2, 1, 1.2]
    [fluid]
    acceleration = [0, 0, -9.81]
    [particles]
    spacing = 0.1
    plane = true
    [boundaries]
    x_min = { kind = "wall" }
    x_max = { kind = "wall" }
    z_min = { kind = "wall" }
    z_max = { kind = "open" }
    [[water]]
    kind = "box"
    size = [1.2, 1, 0.8]
    position = [0.6, 0.5, 0.4]
    [run]
    steps = 12
"#;

/// The scene of a text, as if from `scene.toml` in the working folder.
///
/// # Errors
/// What the text has wrong.
pub fn read(text: &str) -> Result<Scene> {
    Scene::from_toml(text, Path::new(""), "scene.toml")
}
