//! A block on an incline: s = ½gt²(sin α − cos α tan φ); it sticks if φ ≥ α.

use crate::fixture::{blocks, cuboid, joint, run, settled, setup, slope};
use glam::DVec3;
use riprap::rock::{Block, Setup};

const ALPHA: f64 = 30.0;
const STIFFNESS: f64 = 1e8;
const G: f64 = 9.81;

/// A flat block on an incline, pressed in as it will be.
pub fn on_incline(phi: f64) -> Setup {
    let turn = slope(ALPHA.to_radians());
    let height = 0.4;
    let pressed = 2500.0 * height * G * ALPHA.to_radians().cos() / STIFFNESS;
    let plate = Block::new(
        "plate",
        cuboid(12.0, 3.0, 1.0),
        turn * DVec3::new(4.0, 0.0, -0.5),
    );
    let at = turn * DVec3::Z * (0.5 * height - pressed);
    let block = Block::new("block", cuboid(1.0, 1.0, height), at);
    setup(
        vec![plate.fixed().turned(turn), block.turned(turn)],
        joint(STIFFNESS, phi),
    )
}

/// Way down the incline in `t` seconds from rest, m, and the speed then, m/s. The block is held by
/// friction until it carries its weight, and only then gets the friction angle `phi`.
fn way(phi: f64, t: f64) -> (f64, f64) {
    let held = settled(&on_incline(60.0), 100.0, 0.3);
    let mut blocks = blocks(on_incline(phi));
    blocks.restore(&held).expect("the same blocks");
    let start = blocks.poses()[1].centre;
    run(&mut blocks, held.time() + t);
    let down = slope(ALPHA.to_radians()) * DVec3::X;
    let way = (blocks.poses()[1].centre - start).dot(down);
    (way, blocks.largest_speed())
}

#[test]
fn it_slides_as_coulomb_says() {
    let (phi, t): (f64, f64) = (20.0, 1.0);
    let [alpha, tan_phi] = [ALPHA.to_radians(), phi.to_radians().tan()];
    let exact = 0.5 * G * t * t * (alpha.sin() - alpha.cos() * tan_phi);
    let (found, _) = way(phi, t);
    assert!((found / exact - 1.0).abs() < 1e-3, "{found} m, {exact} m");
}

#[test]
fn it_slips_a_tenth_of_a_degree_below_and_holds_as_much_above() {
    let (found, _) = way(29.9, 1.0);
    // ½gt²(sin α − cos α tan 29.9°), α = 30°.
    let [alpha, phi] = [30f64, 29.9].map(f64::to_radians);
    let exact = 0.5 * G * (alpha.sin() - alpha.cos() * phi.tan());
    assert!((found / exact - 1.0).abs() < 1e-2, "{found} m, {exact} m");

    let (found, speed) = way(30.1, 1.0);
    // It is held already: nothing is left to move.
    assert!(found.abs() < 1e-6, "{found} m");
    assert!(speed < 1e-6, "{speed} m/s");
}
