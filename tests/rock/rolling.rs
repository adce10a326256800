//! A sphere that rolls: a = 5/7 g sin α without slip; after a start with slip on a level plate, v = 5/7 v₀.
//!
//! Its rolling radius is less than its radius by the overlap of about 0.1 mm, 1/2000: the error of a is twice that.

use crate::fixture::{blocks, cuboid, joint, run, setup, slope};
use glam::DVec3;
use kit::assert_relative;
use riprap::{
    geometry::Shape,
    rock::{Block, Blocks},
};

const RADIUS: f64 = 0.2;
const STIFFNESS: f64 = 1e11;
const G: f64 = 9.81;
const FRICTION: f64 = 30.0;

/// A sphere on a plate that slopes down by `alpha` degrees along x, at its equilibrium overlap. Contacts have a tenth of
/// the critical damping.
fn on_plate(alpha: f64, velocity: DVec3) -> Blocks {
    let turn = slope(alpha);
    let volume = 4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3);
    let weight = 2500.0 * volume * G * alpha.to_radians().cos();
    // The section is a circle with an area of 2π r u.
    let pressed = (weight / (STIFFNESS * std::f64::consts::TAU * RADIUS)).sqrt();
    let plate = cuboid(12.0, 3.0, 1.0);
    let plate = Block::new("plate", plate, turn * DVec3::new(4.0, 0.0, -0.5));
    let sphere = Shape::sphere(RADIUS).expect("the radius is positive");
    let at = turn * DVec3::Z * (RADIUS - pressed);
    let mut sphere = Block::new("sphere", sphere, at);
    sphere.velocity = turn * velocity;
    let mut joint = joint(STIFFNESS, FRICTION);
    joint.damping = 0.1;
    blocks(setup(vec![plate.fixed().rotated(turn), sphere], joint))
}

fn motion(blocks: &Blocks) -> (DVec3, DVec3) {
    let spin = blocks.spins().nth(1).expect("there are two");
    (blocks.poses()[1].velocity, spin)
}

#[test]
fn it_gains_five_sevenths_of_what_pulls_it_down_an_incline() {
    let alpha = 20.0;
    let mut blocks = on_plate(alpha, DVec3::ZERO);
    run(&mut blocks, 0.2);
    let (before, spin_before) = motion(&blocks);
    run(&mut blocks, 0.7);
    let (after, spin) = motion(&blocks);
    let exact = 5.0 / 7.0 * G * f64::to_radians(alpha).sin();
    let found = (after - before).dot(slope(alpha) * DVec3::X) / 0.5;
    assert_relative(found, exact, 1e-3);
    let turning = (spin - spin_before).y / 0.5 * RADIUS;
    assert_relative(turning, exact, 1e-3);
}

/// The angular momentum about the contact is conserved for any friction.
#[test]
fn one_that_slides_on_the_level_ends_with_five_sevenths_of_its_speed() {
    let start = 2.0;
    let mut blocks = on_plate(0.0, DVec3::X * start);
    // It slides for 2/7 v₀/(g tan φ) = 0.10 s.
    run(&mut blocks, 1.0);
    let (velocity, spin) = motion(&blocks);
    let exact = 5.0 / 7.0 * start;
    assert_relative(velocity.x, exact, 1e-3);
    assert_relative(spin.y * RADIUS, exact, 1e-3);
}
