//! A cube that falls on its corner.

use crate::fixture::{blocks, cuboid, joint, run, setup, try_run};
use glam::{DQuat, DVec3};
use riprap::rock::{Block, Setup};

/// k_n, Pa/m.
const STIFFNESS: f64 = 1e8;
/// kg, of a cube of 1 m.
const MASS: f64 = 2500.0;
/// Impact speed, m/s.
const SPEED: f64 = 0.5;

/// A cube above a floor, a corner down, without damping.
fn falling(corner_area: f64) -> Setup {
    let half_diagonal = 0.75f64.sqrt();
    let turn = DQuat::from_rotation_arc(DVec3::ONE.normalize(), DVec3::NEG_Z);
    let floor = Block::new("floor", cuboid(9.0, 9.0, 1.0), DVec3::Z * -0.5).fixed();
    let at = DVec3::Z * (half_diagonal + 1e-4);
    let mut cube = Block::new("cube", cuboid(1.0, 1.0, 1.0), at).rotated(turn);
    cube.velocity = DVec3::Z * -SPEED;
    let mut law = joint(STIFFNESS, 30.0);
    law.damping = 0.0;
    Setup {
        corner_area,
        gravity: DVec3::ZERO,
        ..setup(vec![floor, cube], law)
    }
}

/// Largest overlap of the cube, and its rebound velocity.
fn struck(corner_area: f64) -> (f64, f64) {
    let mut blocks = blocks(Setup {
        largest_overlap: 0.5,
        ..falling(corner_area)
    });
    let mut deepest = 0.0f64;
    for step in 1..=400 {
        run(&mut blocks, 1e-3 * f64::from(step));
        deepest = blocks
            .contacts()
            .fold(deepest, |most, c| most.max(c.overlap));
    }
    assert_eq!(blocks.contacts().count(), 0, "it has left");
    (deepest, blocks.poses()[1].velocity.z)
}

/// ½mv² is the spring's energy: ½ k_n A u² with a prescribed area, k_n c u⁴/4 with the area of the section
/// through the analytic centre, which is the centroid of the corner: c = (3√3/2)(3/4)².
#[test]
fn sinks_until_the_spring_holds_its_energy_and_gets_it_back() {
    let energy = 0.5 * MASS * SPEED * SPEED;
    let c = 1.5 * 3f64.sqrt() * 0.5625;
    let section = (4.0 * energy / (STIFFNESS * c)).powf(0.25);
    let quarter = (2.0 * energy / (STIFFNESS * 0.25)).sqrt();
    assert!(quarter < 0.15 * section);
    for (corner_area, exact) in [(0.0, section), (0.25, quarter)] {
        let (deepest, speed) = struck(corner_area);
        assert!(
            (deepest / exact - 1.0).abs() < 0.01,
            "{corner_area}: {deepest} m, {exact} m"
        );
        assert!(
            (speed / SPEED - 1.0).abs() < 1e-3,
            "{corner_area}: {speed} m/s"
        );
    }
}

/// By the energies above, the corner penetrates by 5.4 cm with the area of its section, more than a tenth of half an
/// edge, and by 5 mm with a quarter.
#[test]
fn a_corner_that_sinks_too_deep_is_told_of_its_area() {
    let error = try_run(&mut blocks(falling(0.0)), 0.4).expect_err("it sinks too deep");
    let text = error.to_string();
    assert!(text.contains("rock.corner_area = 0.25"), "{text}");
    assert!(text.contains("2.5e-1 m²"), "{text}");
    try_run(&mut blocks(falling(0.25)), 0.4).expect("it is stiff enough");
}
