//! A sphere that rolls: a = 5/7 g sin α without slip; after a start with slip on a level plate, v = 5/7 v₀.
//!
//! Its rolling radius is less than its radius by the overlap of about 0.1 mm, 1/2000: the error of a is twice that.

use crate::fixture::{blocks, cuboid, joint, run, setup, slope};
use glam::DVec3;
use kit::assert_relative;
use riprap::{
    geometry::Shape,
    rock::{Block, Blocks, Setup},
};

const RADIUS: f64 = 0.2;
const STIFFNESS: f64 = 1e11;
const G: f64 = 9.81;
const FRICTION: f64 = 30.0;
/// s, for pieces of any size.
const TIME_STEP: f64 = 1e-5;

/// A sphere on a plate that slopes down by `alpha` degrees along x, at its equilibrium overlap. Contacts have a tenth of
/// the critical damping.
fn on_plate(alpha: f64, velocity: DVec3) -> Blocks {
    on_pieces(alpha, velocity, &[[-2.0, -1.5, 10.0, 1.5]])
}

/// The same on a plate of several pieces, each from one corner (x, y) to the opposite one, m.
fn on_pieces(alpha: f64, velocity: DVec3, pieces: &[[f64; 4]]) -> Blocks {
    let turn = slope(alpha);
    let volume = 4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3);
    let weight = 2500.0 * volume * G * alpha.to_radians().cos();
    // The section is a circle with an area of 2π r u.
    let pressed = (weight / (STIFFNESS * std::f64::consts::TAU * RADIUS)).sqrt();
    let piece = |&[x, y, to_x, to_y]: &[f64; 4]| {
        let centre = DVec3::new(0.5 * (x + to_x), 0.5 * (y + to_y), -0.5);
        let shape = cuboid(to_x - x, to_y - y, 1.0);
        Block::new("plate", shape, turn * centre)
            .fixed()
            .rotated(turn)
    };
    let sphere = Shape::sphere(RADIUS).expect("the radius is positive");
    let at = turn * DVec3::Z * (RADIUS - pressed);
    let mut sphere = Block::new("sphere", sphere, at);
    sphere.velocity = turn * velocity;
    let mut joint = joint(STIFFNESS, FRICTION);
    joint.damping = 0.1;
    let plate = pieces.iter().map(piece);
    let setup = setup([sphere].into_iter().chain(plate).collect(), joint);
    blocks(Setup {
        time_step: Some(TIME_STEP),
        ..setup
    })
}

fn motion(blocks: &Blocks) -> (DVec3, DVec3) {
    let spin = blocks.spins().next().expect("there is a sphere");
    (blocks.poses()[0].velocity, spin)
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

/// The slab under the sphere sinks by more than the one next to it.
#[test]
fn a_step_much_smaller_than_its_overlap_does_not_push_it() {
    let slab = |x: f64| Block::new("slab", cuboid(1.0, 1.0, 0.2), DVec3::new(x, 0.0, -0.1));
    let floor = Block::new("floor", cuboid(4.0, 4.0, 1.0), DVec3::Z * -0.7).fixed();
    let sphere = Shape::sphere(RADIUS).expect("the radius is positive");
    let sphere = Block::new("sphere", sphere, DVec3::new(0.012, 0.0, RADIUS));
    let mut joint = joint(1e8, FRICTION);
    joint.damping = 0.5;
    let mut blocks = blocks(setup(vec![sphere, slab(-0.5), slab(0.5), floor], joint));
    run(&mut blocks, 0.5);
    let [sphere, left, right, _] = blocks.poses()[..] else {
        panic!("four blocks");
    };
    assert!(left.centre.z - right.centre.z > 1e-6, "no step");
    // The slab under it tilts by 821 N · 0.488 m over k_n/12 m⁴ = 4.8e-5: within 0.5 s it rolls by 5/14 of g 4.8e-5 t² = 4.2e-5 m.
    let moved = sphere.centre - DVec3::X * 0.012;
    assert!(moved.truncate().length() < 1e-4, "{moved}");
}

/// Seams across the path, along it, and at nodes: at each only one piece is touched, and it takes over the friction.
#[test]
fn seams_of_a_floor_do_not_disturb_it() {
    let start = DVec3::new(2.0, 0.3, 0.0);
    let paths = |pieces: &[[f64; 4]]| {
        let mut blocks = on_pieces(3.0, start, pieces);
        let path = (1..=8).map(|n| {
            run(&mut blocks, 0.1 * f64::from(n));
            assert!(blocks.contacts().count() <= 1, "at {n}");
            let (velocity, spin) = motion(&blocks);
            [blocks.poses()[0].centre, velocity, spin]
        });
        path.collect::<Vec<_>>()
    };
    let whole = paths(&[[-2.0, -1.5, 10.0, 1.5]]);
    let pieces = [
        [-2.0, -1.5, 0.0, 0.0],
        [-2.0, 0.0, 0.0, 1.5],
        [0.0, -1.5, 0.55, 0.0],
        [0.0, 0.0, 0.31, 1.5],
        [0.31, 0.0, 1.2, 1.5],
        [0.55, -1.5, 10.0, 0.0],
        [1.2, 0.0, 10.0, 0.2],
        [1.2, 0.2, 10.0, 1.5],
    ];
    for (whole, cut) in whole.iter().zip(paths(&pieces)) {
        for (a, b) in whole.iter().zip(cut) {
            assert!(a.distance(b) < 1e-11, "{a} and {b}");
        }
    }
}
