//! Walls and blocks contain the water.

use crate::tank::resting;
use glam::DVec3;
use kit::Rig;
use riprap::{
    scene::{
        Scene,
        build::{block_setup, particle_setup},
    },
    sph::SphSolver,
};
use std::path::Path;

/// A beach with a slope of 4 % meets the floor, the side walls and the end of a channel. Its rows of boundary particles
/// have different phases, and the penalty force must expel water between them.
#[test]
fn a_flat_beach_does_not_leak() {
    let text = r#"
[domain]
origin = [-1, 0, 0]
size = [4, 0.6, 1]
[fluid]
acceleration = [0, 0, -9.81]
[particles]
spacing = 0.1
smoothing = 1.5
largest_speed = 3.2
[boundaries]
x_min = { kind = "wall" }
x_max = { kind = "wall" }
y_min = { kind = "wall" }
y_max = { kind = "wall" }
z_min = { kind = "wall" }
z_max = { kind = "open" }
[[water]]
kind = "box"
size = [4, 0.6, 0.8]
position = [1, 0.3, 0.4]
[[materials]]
name = "rock"
density = 2500
normal_stiffness = 1e8
friction = 30
[[blocks]]
name = "beach"
kind = "vertices"
vertices = [[0, 0, 0], [8, 0, 0], [8, 0, 0.32], [0, 0.6, 0], [8, 0.6, 0], [8, 0.6, 0.32]]
motion = "fixed"
[run]
duration = 1
"#;
    let scene = Scene::from_toml(text, Path::new("."), "beach").unwrap();
    let blocks = block_setup(&scene).unwrap();
    let (setup, start) = particle_setup(&scene, &blocks).unwrap();
    let poses: Vec<_> = blocks
        .setup
        .blocks
        .iter()
        .map(|b| resting(b.centre))
        .collect();
    let spacing = setup.spacing;
    let rig = Rig::new();
    let (device, queue) = (&rig.device, &rig.queue);
    let mut particles = SphSolver::new(
        device,
        queue,
        setup,
        &start.positions,
        &start.velocities,
        &start.pressures,
    )
    .unwrap();
    let clearance = |x: DVec3| {
        let slope = (x.z - 0.04 * x.x) / 0.04f64.hypot(1.0);
        let sides = [x.x + 1.0, 3.0 - x.x, x.y, 0.6 - x.y, x.z, slope];
        sides.into_iter().fold(f64::INFINITY, f64::min)
    };
    let mut deepest = 0.0f64;
    for _ in 0..20 {
        rig.wait(particles.advance(device, queue, &poses, 0.05))
            .unwrap();
        let water = rig.wait(particles.water(device, queue)).unwrap();
        assert_eq!(water.len(), start.positions.len());
        let heights = water.positions.iter().map(|x| clearance(*x));
        deepest = deepest.max(-heights.fold(f64::INFINITY, f64::min) / spacing);
    }
    println!(
        "{} particles, {deepest} spacings deep at most",
        start.positions.len()
    );
    assert!(deepest < 0.5, "{deepest} spacings");
}
