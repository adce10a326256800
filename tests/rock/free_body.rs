//! Free motion of a block, without and with mass damping.

use crate::fixture::{blocks, joint, run, setup};
use glam::{DMat3, DVec3};
use kit::assert_relative;
use riprap::{
    geometry::{Polyhedron, Shape},
    rock::Block,
};
use std::sync::Arc;

#[test]
fn a_free_block_keeps_its_angular_momentum_to_the_last_bit_and_its_energy() {
    // A box with a corner cut off, whose principal axes are not the axes of its frame.
    let corner = |k: u32| {
        DVec3::new(
            f64::from(k & 1),
            1.5 * f64::from(k >> 1 & 1),
            f64::from(k >> 2),
        )
    };
    let corners: Vec<_> = (0..7).map(corner).collect();
    let (shape, _) = Polyhedron::from_vertices(&corners).expect("a polyhedron");
    let inertia = 2500.0 * shape.inertia();
    let shape: Arc<Shape> = Arc::new(shape.into());
    let mut block = Block::new("free", shape, DVec3::ZERO);
    (block.velocity, block.spin) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(3.0, -1.0, 2.0));
    let mut setup = setup(vec![block], joint(1e9, 30.0));
    (setup.gravity, setup.time_step) = (DVec3::ZERO, Some(1e-2));
    let mut blocks = blocks(setup);
    let before = (blocks.angular_momentum(0), blocks.ledger().kinetic);
    run(&mut blocks, 20.0);
    assert_eq!(blocks.angular_momentum(0), before.0);
    let energy = blocks.ledger().kinetic / before.1 - 1.0;
    // Order 2 in |ω|Δt = 0.04.
    assert!(energy.abs() < 2e-4, "{energy}");
    // I ω in world axes is that angular momentum, with the tensor rotated by the pose.
    let r = DMat3::from_quat(blocks.rotation(0));
    let spin = blocks.spins().next().expect("one block");
    let tensor = r * inertia * r.transpose();
    let error = (tensor * spin - before.0).length() / before.0.length();
    assert!(error < 1e-13, "{error}");
    assert!(
        blocks.poses()[0]
            .centre
            .distance(20.0 * DVec3::new(1.0, 2.0, 3.0))
            < 1e-11
    );
}

#[test]
fn mass_damping_slows_motion_and_spin_by_its_formula() {
    let (alpha, dt): (f64, f64) = (2.0, 1e-3);
    let shape = Arc::new(Shape::sphere(0.5).expect("a sphere"));
    let mut block = Block::new("ball", shape, DVec3::ZERO);
    (block.velocity, block.spin) = (DVec3::X, DVec3::Y);
    let mut setup = setup(vec![block], joint(1e9, 30.0));
    (setup.gravity, setup.time_step, setup.damping) = (DVec3::ZERO, Some(dt), alpha);
    let mut blocks = blocks(setup);
    let start = blocks.ledger().kinetic;
    run(&mut blocks, 1.0);
    // v at whole steps lies between the half-step velocities, which fall by (1 − h)/(1 + h), h = αΔt/2.
    let h: f64 = 0.5 * alpha * dt;
    let fall = ((1.0 - h) / (1.0 + h)).powi(1000);
    assert_relative(blocks.poses()[0].velocity.x, fall, 1e-12);
    assert_relative(blocks.spins().next().expect("one").y, fall, 1e-12);
    assert_relative(fall, (-alpha).exp(), 1e-6);
    let ledger = blocks.ledger();
    assert_relative(ledger.balance(), start, 1e-5);
}
