//! A block that hits a fixed one: the contact damps, and does not pull.

use crate::fixture::{blocks, cuboid, joint, run, setup};
use glam::DVec3;
use riprap::rock::{Block, law::Joint};

/// Rebound speed over impact speed, and the ledger's error over the energy of impact.
fn rebound(zeta: f64) -> (f64, f64) {
    let plate = Block::new("plate", cuboid(3.0, 3.0, 1.0), DVec3::Z * -0.5).fixed();
    let mut block = Block::new("block", cuboid(1.0, 1.0, 1.0), DVec3::Z * 0.5001);
    block.velocity = -DVec3::Z;
    let joint = Joint {
        damping: zeta,
        ..joint(1e7, 30.0)
    };
    let mut setup = setup(vec![plate, block], joint);
    setup.gravity = DVec3::ZERO;
    // ωΔt = 1.3e-3 for ω = √(k_n A/m) = 63 rad/s: where in a step the contact begins and ends changes the
    // momentum by at most 2ζωΔt/2 of itself.
    setup.time_step = Some(2e-5);
    let mut blocks = blocks(setup);
    let energy = blocks.ledger().kinetic;
    run(&mut blocks, 0.08);
    assert_eq!(blocks.contacts().count(), 0, "the block has left");
    let balance = blocks.ledger().balance() / energy - 1.0;
    (blocks.poses()[1].velocity.z, balance)
}

#[test]
fn the_rebound_is_that_of_a_clipped_dashpot() {
    for (zeta, expected) in [(0.05, 0.8588), (0.1, 0.7441), (0.2, 0.5717), (0.5, 0.2984)] {
        let (e, balance) = rebound(zeta);
        assert!((e - expected).abs() < 2e-3, "ζ = {zeta}: {e}, {expected}");
        assert!(balance.abs() < 1e-3, "ζ = {zeta}: {balance}");
    }
}

#[test]
fn without_damping_nothing_is_lost() {
    let (e, balance) = rebound(0.0);
    assert!((e - 1.0).abs() < 1e-5, "{e}");
    assert!(balance.abs() < 1e-5, "{balance}");
}
