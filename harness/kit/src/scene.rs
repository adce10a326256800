//! Scenes that several test programs read.

use riprap::{
    Result,
    scene::{BroadphaseBackend, Kernels, Scene},
};
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

/// The variant of the kernels for coupled scenes in tests: from the environment variable `RIPRAP_KERNELS`, `cpu` or `gpu`,
/// or else by the adapter.
pub fn kernels() -> Kernels {
    match std::env::var("RIPRAP_KERNELS").as_deref() {
        Ok("cpu") => Kernels::Cpu,
        Ok("gpu") => Kernels::Gpu,
        Ok(other) => panic!("RIPRAP_KERNELS is {other}; possible are cpu and gpu"),
        Err(_) => Kernels::Auto,
    }
}

/// The scene with `kernels`; those of a GPU also imply its broadphase, however few blocks there are.
pub fn for_kernels(scene: &Scene, kernels: Kernels) -> Scene {
    let mut scene = scene.clone();
    scene.run.kernels = kernels;
    if kernels == Kernels::Gpu && scene.rock.broadphase == BroadphaseBackend::Auto {
        scene.rock.broadphase = BroadphaseBackend::Device;
    }
    scene
}

/// Parses a scene, as if from `scene.toml` in the working folder.
pub fn read(text: &str) -> Result<Scene> {
    Scene::from_toml(text, Path::new(""), "scene.toml")
}
