//! Particles at the start: those of the water, and those inside what holds it.

mod advice;
mod fill;
mod gauges;
mod kernel;
mod seam;
mod shell;

use glam::DVec3;
use riprap::particles::{Start, fill, shells};
use riprap::scene::Scene;
use riprap::simulation::{BlockSetup, block_setup};
use std::path::Path;

/// Δx of all scenes here, m.
const DX: f64 = 0.05;

/// A tank of 2 × 1 × 1 m with water to the half, its sides along y periodic, and more tables after it.
fn tank(more: &str) -> riprap::Result<Scene> {
    scene("", more)
}

/// The same with more keys of particles.
fn scene(particles: &str, more: &str) -> riprap::Result<Scene> {
    let text = format!(
        r#"
[domain]
size = [2.0, 1.0, 1.0]
[fluid]
acceleration = [0, 0, -9.81]
[particles]
spacing = 0.05
{particles}
[boundaries]
x_min = {{ kind = "wall" }}
x_max = {{ kind = "wall" }}
z_min = {{ kind = "wall" }}
z_max = {{ kind = "open" }}
[[water]]
kind = "box"
size = [2.0, 1.0, 0.5]
position = [1.0, 0.5, 0.25]
[[materials]]
name = "rock"
density = 2500
normal_stiffness = 1e8
friction = 30
[run]
duration = 1
{more}"#
    );
    Scene::from_toml(&text, Path::new("."), "tank.toml")
}

/// Everything there is of a scene.
struct Made {
    setup: BlockSetup,
    start: Start,
    /// Shell points of each block from its centroid, m.
    shells: Vec<Vec<DVec3>>,
}

impl Made {
    fn of(scene: &Scene) -> Self {
        let setup = block_setup(scene).unwrap();
        Self {
            start: fill(scene, &setup).unwrap(),
            shells: shells(scene, &setup).unwrap(),
            setup,
        }
    }

    /// The number of a block.
    fn block(&self, name: &str) -> usize {
        let blocks = &self.setup.setup.blocks;
        blocks.iter().position(|b| b.name == name).unwrap()
    }

    /// Shell points of a block where they are, m.
    fn shell(&self, name: &str) -> Vec<DVec3> {
        let index = self.block(name);
        let block = &self.setup.setup.blocks[index];
        let place = |x: &DVec3| block.centre + block.rotation * *x;
        self.shells[index].iter().map(place).collect()
    }

    /// All shell points where they are, m.
    fn all_shells(&self) -> Vec<DVec3> {
        let blocks = &self.setup.setup.blocks;
        blocks.iter().flat_map(|b| self.shell(&b.name)).collect()
    }
}

/// What is wrong with a scene, in words.
fn fault(scene: &Scene) -> String {
    let setup = block_setup(scene).unwrap();
    let made = fill(scene, &setup).map(drop);
    let made = made.and_then(|()| shells(scene, &setup).map(drop));
    made.expect_err("this must be refused").to_string()
}

/// Number of multiples of a spacing and a half, to a millionth of it.
fn is_on_lattice(x: f64, origin: f64) -> bool {
    let at = (x - origin) / DX - 0.5;
    (at - at.round()).abs() < 1e-6
}

/// The least distance of two of the points, m.
fn nearest(points: &[DVec3]) -> f64 {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x));
    let mut least = f64::INFINITY;
    for (i, a) in sorted.iter().enumerate() {
        for b in &sorted[i + 1..] {
            if b.x - a.x >= least {
                break;
            }
            least = least.min(a.distance(*b));
        }
    }
    least
}
