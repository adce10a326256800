//! Scenes with their initial fluid and boundary particles.

use glam::DVec3;
use riprap::scene::Scene;
use riprap::scene::build::{BlockSetup, block_setup};
use riprap::{
    scene::build::{boundary_particles, fill},
    sph::Start,
};
use std::path::Path;

/// Δx of all scenes, m.
pub const DX: f64 = 0.05;

/// A half-full tank of 2 × 1 × 1 m, periodic along y, with further tables.
pub fn tank(more: &str) -> riprap::Result<Scene> {
    scene("", more)
}

/// The same tank with further keys of the table of particles.
pub fn scene(particles: &str, more: &str) -> riprap::Result<Scene> {
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

/// A scene with its initial particles.
pub struct Initial {
    pub setup: BlockSetup,
    pub start: Start,
    /// Boundary particles of each block relative to its centroid, m.
    pub boundary: Vec<Vec<DVec3>>,
}

impl Initial {
    pub fn of(scene: &Scene) -> Self {
        let setup = block_setup(scene).unwrap();
        Self {
            start: fill(scene, &setup).unwrap(),
            boundary: boundary_particles(scene, &setup).unwrap(),
            setup,
        }
    }

    /// Index of a block.
    pub fn block(&self, name: &str) -> usize {
        let blocks = &self.setup.setup.blocks;
        blocks.iter().position(|b| b.name == name).unwrap()
    }

    /// Boundary particles of a block in the world frame, m.
    pub fn boundary_of(&self, name: &str) -> Vec<DVec3> {
        let index = self.block(name);
        let block = &self.setup.setup.blocks[index];
        let position = |x: &DVec3| block.centre + block.rotation * *x;
        self.boundary[index].iter().map(position).collect()
    }

    /// All boundary particles in the world frame, m.
    pub fn all_boundary(&self) -> Vec<DVec3> {
        let blocks = &self.setup.setup.blocks;
        blocks
            .iter()
            .flat_map(|b| self.boundary_of(&b.name))
            .collect()
    }
}

/// The message of the error of an invalid scene.
pub fn error_of(scene: &Scene) -> String {
    let setup = block_setup(scene).unwrap();
    let result = fill(scene, &setup).map(drop);
    let result = result.and_then(|()| boundary_particles(scene, &setup).map(drop));
    result.expect_err("the scene is invalid").to_string()
}

/// Whether a coordinate is a whole number of spacings and a half from the origin, to a millionth of a spacing.
pub fn is_on_lattice(x: f64, origin: f64) -> bool {
    let at = (x - origin) / DX - 0.5;
    (at - at.round()).abs() < 1e-6
}

/// Least distance of two points, m.
pub fn least_distance(points: &[DVec3]) -> f64 {
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

/// Distance of a point from the nearest of others, m.
pub fn distance_to_nearest(point: DVec3, others: &[DVec3]) -> f64 {
    let squares = others.iter().map(|x| x.distance_squared(point));
    squares.fold(f64::INFINITY, f64::min).sqrt()
}
