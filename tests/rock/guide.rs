//! Blocks on guides.

use crate::fixture::{assert_restarts, blocks, cube, cuboid, joint, run, setup};
use glam::{DMat3, DQuat, DVec3};
use riprap::{
    geometry::Load,
    rock::{Block, Blocks, Guide, Motion, broadphase::HostBroadphase},
};

const AXIS: DVec3 = DVec3::new(3.0, 0.0, -4.0);

fn guided(list: Vec<Block>) -> riprap::rock::Setup {
    let mut setup = setup(list, joint(1e8, 30.0));
    setup.guides = vec![Guide {
        block: 0,
        axis: AXIS,
    }];
    setup
}

/// Down a rail of 53°: a = g sin 53° exactly, regardless of transverse forces and torques.
#[test]
fn it_falls_along_its_rail_as_on_a_slope_without_friction() {
    let turn = DQuat::from_rotation_x(0.3);
    let cube = Block::new("cube", cuboid(1.0, 0.5, 0.7), DVec3::ZERO).rotated(turn);
    let mut setup = guided(vec![cube]);
    setup.time_step = Some(1e-3);
    let mut blocks = blocks(setup);
    let start = blocks.ledger();
    let across = Load::at(DVec3::new(4e3, 1e3, 3e3), DVec3::new(0.2, 0.4, -0.1));
    blocks.set_loads(&[across]).expect("one load");
    run(&mut blocks, 2.0);
    let pose = blocks.poses()[0];
    let axis = AXIS.normalize();
    let rate = 9.81 * 0.8 + across.force.dot(axis) / (2500.0 * 0.35);
    let way = axis * 0.5 * rate * 4.0;
    assert!((pose.centre - way).length() < 1e-9, "{}", pose.centre);
    assert!((pose.velocity - axis * 2.0 * rate).length() < 1e-9);
    let turned = pose.deformation - DMat3::from_quat(turn);
    assert!(turned.x_axis.length() + turned.y_axis.length() < 1e-12);
    let change = blocks.ledger().balance() - start.balance();
    assert!(change.abs() < 1e-9 * blocks.ledger().kinetic, "{change} J");
}

/// A guided block strikes another one off its centre: the struck block rotates, the guided one only slows down, and only
/// the contact dissipates energy. A restart gives the same bits.
#[test]
fn it_strikes_another_and_stays_on_its_rail() {
    let hit = DVec3::new(1.5, 0.0, -2.6);
    let mut cube = cube("cube", 0.0);
    cube.velocity = AXIS;
    let setup = guided(vec![cube, Block::new("struck", cuboid(1.0, 1.0, 1.0), hit)]);
    let start = blocks(setup.clone()).ledger();
    let whole = assert_restarts(&setup, 0.3, 0.8);
    let [cube, struck] = [0, 1].map(|block| whole.poses()[block]);
    // Rounding adds up over the steps.
    let aside = cube.centre.cross(AXIS.normalize()).length();
    assert!(aside < 1e-10, "{aside} m");
    let turned = cube.deformation - DMat3::IDENTITY;
    assert!(turned.x_axis.length() + turned.y_axis.length() < 1e-12);
    assert!(struck.deformation_rate.x_axis.length() > 0.1 && struck.velocity.x > 0.1);
    let ledger = whole.ledger();
    let error = (ledger.balance() - start.balance()).abs();
    assert!(error < 1e-3 * start.kinetic, "{error} J of {ledger:?}");
}

/// Blocks that overlap at the start go apart along the guide, or are refused if it leaves no room.
#[test]
fn it_is_relaxed_along_its_rail() {
    let relaxed = |axis: DVec3, other: DVec3| {
        let other = Block::new("other", cuboid(1.0, 1.0, 1.0), other).fixed();
        let mut setup = guided(vec![cube("cube", 0.0), other]);
        setup.guides[0].axis = axis;
        let mut blocks = blocks(setup);
        let result = pollster::block_on(blocks.relax(&mut HostBroadphase, 100));
        result.map(|_| blocks.poses()[0].centre)
    };
    let other = DVec3::new(0.95, 0.0, 0.0);
    let centre = relaxed(AXIS, other).unwrap();
    assert!(centre.cross(AXIS).length() < 1e-12, "{centre}");
    assert!((centre.x + 0.05).abs() < 1e-3, "{centre}");
    assert!(relaxed(DVec3::Z, other).is_err());
}

#[test]
fn what_cannot_slide_is_refused() {
    let cube = || cube("cube", 0.0);
    let refusal = |block: Block, axis: DVec3| {
        let mut setup = guided(vec![block]);
        setup.guides[0].axis = axis;
        Blocks::new(setup).expect_err("no rail for it").to_string()
    };
    let mut aside = cube();
    aside.velocity = DVec3::X;
    let mut turning = cube();
    turning.spin = DVec3::X;
    let mut still = cube();
    still.motion = Motion::Fixed;
    for (block, axis, told) in [
        (cube(), DVec3::ZERO, "axis"),
        (aside, DVec3::Z, "along its guide"),
        (turning, DVec3::Z, "spin 0"),
        (still, DVec3::Z, "only a free rigid block"),
    ] {
        let text = refusal(block, axis);
        assert!(text.contains("cube") && text.contains(told), "{text}");
    }
}
