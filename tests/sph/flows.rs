//! Small flows: walls and blocks contain the water, planar scenes stay planar, and a restart changes no bit.

use crate::tank::{Tank, lattice, resting, walls};
use glam::{DMat3, DVec3};
use kit::{Rig, assert_near};
use riprap::{
    geometry::Pose,
    scene::{
        Scene,
        build::{block_setup, particle_setup},
    },
    sph::{Body, NeighbourSearch, Setup, Side},
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
    let resting = blocks.setup.blocks.iter().map(|b| resting(b.centre));
    let poses = resting.collect();
    let spacing = setup.spacing;
    let mut tank = Tank::moving(
        setup,
        poses,
        &start.positions,
        &start.velocities,
        &start.pressures,
    );
    let clearance = |x: DVec3| {
        let slope = (x.z - 0.04 * x.x) / 0.04f64.hypot(1.0);
        let sides = [x.x + 1.0, 3.0 - x.x, x.y, 0.6 - x.y, x.z, slope];
        sides.into_iter().fold(f64::INFINITY, f64::min)
    };
    let mut deepest = 0.0f64;
    for _ in 0..20 {
        tank.advance(0.05);
        let water = tank.water();
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

/// A plate moves into the water, offset and tilted by as much as rounding may reach in a long run. Particles outside the
/// plane would repel each other and leave it within a second.
#[test]
fn an_offset_body_keeps_the_water_in_the_plane() {
    let spacing = 0.05;
    let mut setup = Setup::tank(DVec3::new(1.0, 1.0, 0.8), spacing, 40.0);
    setup.plane = true;
    setup.faces[2][1] = Side::Open;
    let mut plate = Body {
        moves: true,
        loaded: true,
        accelerates: true,
        ..Default::default()
    };
    plate.boundary = lattice(&setup, [-4, 0, 0], [0, 1, 16]);
    for x in &mut plate.boundary {
        x.y = 0.0;
    }
    setup.bodies = vec![walls(&setup), plate];
    let positions = lattice(&setup, [1, 0, 0], [20, 1, 8]);
    let tilt = 1e-3;
    let mut off = Pose {
        centre: DVec3::new(0.0, 0.5 + 1e-3, 0.0),
        velocity: DVec3::new(0.3, 0.02, 0.0),
        ..resting(DVec3::ZERO)
    };
    off.deformation = DMat3::from_rotation_x(tilt) * off.deformation;
    off.deformation_rate = DMat3::from_cols(DVec3::ZERO, DVec3::Z * tilt, -DVec3::Y * tilt);
    let poses = vec![resting(DVec3::ZERO), off];
    let mut tank = Tank::new(setup, poses, &positions, |x: DVec3| {
        9810.0 * (0.4 - x.z).max(0.0)
    });
    let step = 2e-3;
    for _ in 0..150 {
        let load = tank.advance(step).loads[1];
        assert!(load.force.x != 0.0);
        assert_eq!(load.force.y, 0.0);
        assert_eq!([load.torque().x, load.torque().z], [0.0; 2]);
        let next = tank.poses[1].after(step);
        tank.poses[1] = next;
    }
    let water = tank.water();
    assert_eq!(water.len(), positions.len());
    assert!(water.velocities.iter().all(|v| v.y == 0.0));
    assert!(water.velocities.iter().any(|v| v.x > 0.1));
}

/// Neighbour lists are rebuilt after a particle has escaped, and not a second time after a restart.
#[test]
fn a_restart_after_an_escape_sorts_as_often() {
    let spacing = 0.05;
    let mut setup = Setup::tank(DVec3::new(0.5, spacing, 0.6), spacing, 44.0);
    setup.plane = true;
    setup.neighbours = NeighbourSearch::Lists;
    setup.faces[2][1] = Side::Open;
    setup.bodies = vec![walls(&setup)];
    let mut positions = lattice(&setup, [0; 3], [10, 1, 8]);
    let mut velocities = vec![DVec3::ZERO; positions.len()];
    // A drop that escapes, slow enough for lists to be valid for several steps.
    positions.push(DVec3::new(0.25, 0.5 * spacing, 0.599));
    velocities.push(DVec3::Z);
    let pressure = |x: &DVec3| 9810.0 * (0.4 - x.z).max(0.0);
    let pressures: Vec<f64> = positions.iter().map(pressure).collect();
    let start = || {
        let poses = vec![resting(DVec3::ZERO)];
        Tank::moving(setup.clone(), poses, &positions, &velocities, &pressures)
    };
    let advance = |tank: &mut Tank| {
        let done = tank.advance(5e-3);
        let Rig { device, queue } = &tank.rig;
        let all = tank.particles.particles(device, queue);
        (done, tank.rig.wait(all).unwrap())
    };
    let mut whole = start();
    let (_, saved) = advance(&mut whole);
    assert_eq!(whole.particles.escaped(), 1);
    let state = whole.particles.state();
    whole.particles.force_sort();
    let (done, uncut) = advance(&mut whole);
    assert!(done.steps > 2, "{done:?}");
    let mut other = start();
    other
        .particles
        .restore(&other.rig.queue, &saved, &state)
        .unwrap();
    let (redone, restarted) = advance(&mut other);
    assert_eq!(redone.sorts, done.sorts);
    assert!(restarted == uncut);
}

#[test]
fn the_largest_speed_is_that_of_all_steps() {
    let spacing = 0.1;
    let mut setup = Setup::tank(DVec3::new(1.0, spacing, 2.0), spacing, 40.0);
    setup.plane = true;
    setup.bodies = vec![walls(&setup)];
    let drop = [DVec3::new(0.5, 0.5 * spacing, 1.5)];
    let mut tank = Tank::new(setup, vec![resting(DVec3::ZERO)], &drop, |_| 0.0);
    tank.advance(0.2);
    let fallen = f64::from(tank.water().velocities[0].length());
    assert_near(fallen, 9.81 * 0.2, 1e-3);
    assert_near(tank.particles.max_speed(), fallen, 1e-5);
    // It bounces off the floor.
    tank.advance(2.0);
    let now = f64::from(tank.water().velocities[0].length());
    let fastest = tank.particles.max_speed();
    assert!(now < 0.8 * fastest && fastest > 4.0, "{now} {fastest}");
}
