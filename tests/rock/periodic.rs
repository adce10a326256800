//! Periodic space: blocks touch the images of others.

use crate::fixture::{assert_restarts, blocks, cuboid, joint, run, setup};
use glam::{DQuat, DVec3};
use kit::{assert_contains, assert_near, assert_relative};
use riprap::{
    geometry::{Load, Shape},
    rock::{
        Block, Blocks, Period, Setup,
        broadphase::{Broadphase, HostBroadphase},
        law::Film,
    },
};

/// A period along x, from 0 to `length`.
fn along_x(length: f64) -> Option<Period> {
    Some(Period {
        origin: DVec3::ZERO,
        size: DVec3::new(length, f64::INFINITY, f64::INFINITY),
    })
}

/// Two blocks that strike each other obliquely, and a ball that approaches them and is slowed by a film.
fn strike(at: DVec3, period: Option<Period>) -> Setup {
    let turn = DQuat::from_scaled_axis(DVec3::new(0.3, 0.2, 0.5));
    let mut left = Block::new("left", cuboid(0.8, 0.7, 0.6), at - DVec3::X * 0.6).rotated(turn);
    left.velocity = DVec3::X;
    let mut right = Block::new("right", cuboid(0.7, 0.7, 0.7), at + DVec3::X * 0.55);
    right.spin = DVec3::new(1.0, -2.0, 0.5);
    let ball = Shape::sphere(0.2).expect("a radius");
    let mut ball = Block::new("ball", ball, at + DVec3::new(1.2, 0.0, 0.05));
    ball.velocity = DVec3::X * -0.5;
    Setup {
        gravity: DVec3::ZERO,
        period,
        time_step: Some(1e-4),
        largest_overlap: 0.3,
        film: Some(Film {
            viscosity: 50.0,
            round: 0.05,
            flat: 0.05,
            roughness: 1e-3,
            delay: None,
            slip: Vec::new(),
        }),
        ..setup(vec![left, right, ball], joint(3e7, 30.0))
    }
}

/// Blocks behave across the border, wherever it is, as in the middle.
#[test]
fn blocks_that_meet_across_the_border_do_as_those_in_the_middle() {
    let away = DVec3::new(3.0, 1.0, -2.0);
    let mut middle = blocks(strike(away, None));
    run(&mut middle, 0.6);
    let ledger = middle.ledger();
    assert!(ledger.friction > 0.0 && ledger.film > 0.0, "{ledger:?}");
    // The border between the two centres, inside of each block, and periods away.
    for at in [0.0, -0.6, 0.5, 1.2, 13.0, -26.2] {
        let at = DVec3::new(at, 1.0, -2.0);
        // Each block starts in a different period.
        let mut setup = strike(at, along_x(6.5));
        for (k, block) in setup.blocks.iter_mut().enumerate() {
            block.centre.x += [0.0, 6.5, -13.0][k];
        }
        let mut across = blocks(setup);
        run(&mut across, 0.6);
        for (k, (found, expected)) in across.poses().iter().zip(middle.poses()).enumerate() {
            let way = found.centre - expected.centre - at + away;
            let way = way - DVec3::X * [0.0, 6.5, -13.0][k];
            assert!(way.length() < 1e-9, "{at}: block {k} is off by {way}");
            assert!((found.velocity - expected.velocity).length() < 1e-8);
            assert!(
                (found.deformation - expected.deformation).abs_diff_eq(glam::DMat3::ZERO, 1e-8)
            );
        }
        let found = across.ledger();
        assert_near(
            found.dissipated(),
            ledger.dissipated(),
            1e-8 * ledger.dissipated(),
        );
    }
}

/// A row of blocks that fills a ring except for a gap: an impact travels around it and comes back.
#[test]
fn a_blow_goes_round_a_ring() {
    let mut list = Vec::new();
    for k in 0..8 {
        let at = DVec3::X * (0.5 + 1.001 * f64::from(k));
        list.push(Block::new(format!("{k}"), cuboid(1.0, 1.0, 1.0), at));
    }
    // The first block moves backwards, over the border, into the last one.
    list[0].velocity = DVec3::X * -0.5;
    let mut setup = Setup {
        gravity: DVec3::ZERO,
        period: along_x(8.2),
        ..setup(list, joint(1e8, 30.0))
    };
    setup.materials[0].joint.damping = 0.0;
    let start = blocks(setup.clone()).ledger();
    let blocks = assert_restarts(&setup, 0.8, 3.6);
    let momentum: DVec3 = (0..8)
        .map(|k| blocks.mass(k) * blocks.poses()[k].velocity)
        .sum();
    let expected = -0.5 * blocks.mass(0);
    assert!((momentum.x / expected - 1.0).abs() < 1e-12 && momentum.y.abs() < 1e-9);
    let end = blocks.ledger();
    assert_relative(end.balance(), start.balance(), 1e-3);
    // Each block has been struck and displaced.
    for (k, pose) in blocks.poses().iter().enumerate() {
        let way = pose.centre.x - (0.5 + 1.001 * k as f64);
        assert!(way < -0.05, "block {k} moved by {way}");
    }
}

/// Over the border of a floor as long as the period, and of a longer floor, without a jolt.
#[test]
fn a_block_slides_over_the_border_of_its_floor() {
    for length in [4.0, 12.0] {
        let floor = Block::new(
            "floor",
            cuboid(length, 4.0, 1.0),
            DVec3::new(2.0, 0.0, -0.5),
        );
        let mut slider = Block::new(
            "slider",
            cuboid(1.0, 1.0, 0.5),
            DVec3::new(3.0, 0.0, 0.2499),
        );
        slider.velocity = DVec3::X * 4.0;
        let setup = Setup {
            period: along_x(4.0),
            ..setup(vec![floor.fixed(), slider], joint(1e8, 20.0))
        };
        let mut blocks = blocks(setup);
        let mut before = 4.0;
        for n in 1..=20 {
            run(&mut blocks, 0.05 * f64::from(n));
            let pose = blocks.poses()[1];
            let expected = 9.81 * 20f64.to_radians().tan() * 0.05;
            let lost = before - pose.velocity.x;
            assert!(
                (lost / expected - 1.0).abs() < 0.05,
                "{length}, {n}: {lost} of {expected}"
            );
            assert!(
                (pose.centre.z - 0.25).abs() < 2e-4,
                "{length}, {n}: {}",
                pose.centre
            );
            before = pose.velocity.x;
        }
        assert!(before > 0.0 && blocks.poses()[1].centre.x > 5.0);
    }
}

/// A block near the border has one contact with a floor that is longer than the period, also if its image comes near a block on
/// the other side.
#[test]
fn images_of_a_block_share_its_contact_with_a_long_floor() {
    for across in [false, true] {
        let size = |length: f64| if length > 0.0 { length } else { f64::INFINITY };
        let floor = Block::new("floor", cuboid(9.0, 9.0, 1.0), DVec3::new(2.0, 2.0, -0.5));
        let at = |x: f64, z: f64| DVec3::new(x, if across { x } else { 2.0 }, z);
        let resting = Block::new("resting", cuboid(1.0, 1.0, 0.5), at(3.45, 0.2499));
        let other = Block::new("other", cuboid(1.0, 1.0, 0.5), at(0.05, 2.0));
        let mut blocks = blocks(Setup {
            period: Some(Period {
                origin: DVec3::ZERO,
                size: DVec3::new(4.0, size(if across { 4.0 } else { 0.0 }), f64::INFINITY),
            }),
            ..setup(
                vec![floor.fixed(), resting, other.fixed()],
                joint(1e8, 20.0),
            )
        });
        run(&mut blocks, 0.01);
        assert_eq!(blocks.contacts().count(), 1, "{across}");
    }
}

#[test]
fn all_finders_see_the_same_pairs_of_images() {
    let mut list = Vec::new();
    for k in 0..200u32 {
        let place = |step: f64| 5.0 * (0.5 + step * f64::from(k)).fract();
        let at = DVec3::new(place(0.819_172_5), place(0.671_043_6), place(0.549_700_5));
        list.push(Block::new(format!("{k}"), cuboid(0.6, 0.5, 0.4), at));
    }
    let period = Some(Period {
        origin: DVec3::ZERO,
        size: DVec3::splat(5.0),
    });
    let blocks = blocks(Setup {
        period,
        time_step: Some(1e-4),
        ..setup(list.clone(), joint(1e7, 30.0))
    });
    let items = blocks.aabbs();
    let found = pollster::block_on(HostBroadphase.pairs(&items)).expect("pairs");
    let mut counted = blocks;
    counted.set_pairs(found).expect("the pairs of its items");
    // All pairs of blocks, with nearest images.
    let half = 0.5 * counted.skin();
    let reach = DVec3::new(0.6, 0.5, 0.4) + 2.0 * half;
    let mut expected = 0;
    for i in 0..list.len() {
        for j in i + 1..list.len() {
            let apart = list[j].centre - list[i].centre;
            let apart = apart - 5.0 * (apart / 5.0).round();
            expected += usize::from(apart.abs().cmple(reach).all());
        }
    }
    assert!(expected > 20);
    assert_eq!(counted.candidate_pair_count(), expected);
}

#[test]
fn a_block_longer_than_the_period_is_refused_and_may_be_fixed() {
    let plank = Block::new("plank", cuboid(5.0, 1.0, 0.5), DVec3::X);
    let refused = |block: Block| {
        Blocks::new(Setup {
            period: along_x(4.0),
            ..setup(vec![block], joint(1e7, 30.0))
        })
    };
    let message = refused(plank.clone()).expect_err("too long").to_string();
    assert_contains(&message, &["plank", "5", "along x"]);
    refused(plank.fixed()).expect("it is fixed");
}

#[test]
fn a_snapshot_of_another_space_is_refused() {
    let mut apart = strike(DVec3::ZERO, along_x(6.5));
    apart.blocks[1].centre.x += 6.5;
    let mut across = blocks(apart);
    let far = |blocks: &Blocks| {
        blocks
            .contacts()
            .any(|contact| contact.image_shift != DVec3::ZERO)
    };
    for n in 1..=100 {
        run(&mut across, 0.006 * f64::from(n));
        if far(&across) {
            break;
        }
    }
    assert!(far(&across), "they meet across the border");
    let mut middle = blocks(strike(DVec3::ZERO, None));
    assert!(middle.restore(&across.snapshot()).is_err());
    across.restore(&across.snapshot()).expect("its own");
}

/// A block that fills the period turns only about the axis of the period, under a contact and a load off its middle.
#[test]
fn a_block_between_its_own_images_does_not_turn_into_them() {
    for (length, turns) in [(2.0, false), (2.01, false), (2.1, true)] {
        let mut block = Block::new("prism", cuboid(2.0, 0.6, 0.8), DVec3::ZERO)
            .rotated(DQuat::from_rotation_x(0.3));
        block.spin = DVec3::X * 0.2;
        let mut blocks = blocks(Setup {
            gravity: DVec3::ZERO,
            period: along_x(length),
            time_step: Some(1e-3),
            ..setup(vec![block], joint(3e7, 30.0))
        });
        let mass = blocks.mass(0);
        let torque = DVec3::new(0.1, 0.2, -0.3) * mass;
        let moment = glam::DMat3::from_cols(
            DVec3::new(0.0, 0.5 * torque.z, -0.5 * torque.y),
            DVec3::new(-0.5 * torque.z, 0.0, 0.5 * torque.x),
            DVec3::new(0.5 * torque.y, -0.5 * torque.x, 0.0),
        );
        let load = Load {
            moment,
            ..Load::at(DVec3::Y * mass, DVec3::ZERO)
        };
        assert!((load.torque() - torque).length() < 1e-12 * mass);
        blocks.set_loads(&[load]).unwrap();
        run(&mut blocks, 0.5);
        let pose = blocks.poses()[0];
        let along = pose.deformation * DVec3::X;
        assert_eq!(
            (along - DVec3::X).length() > 1e-3,
            turns,
            "{length}: {along}"
        );
        assert_relative(pose.velocity.y, 0.5, 1e-9);
        if !turns {
            let moment = mass * (0.6 * 0.6 + 0.8 * 0.8) / 12.0;
            let spin = riprap::psm::spin(&pose);
            assert_near(spin.x, 0.2 + 0.5 * torque.x / moment, 1e-9);
            assert!((spin - DVec3::X * spin.x).length() < 1e-9, "{spin}");
        }
    }
}

#[test]
fn a_block_that_starts_to_turn_into_its_own_image_is_refused() {
    let mut block = Block::new("prism", cuboid(2.0, 0.6, 0.8), DVec3::ZERO);
    block.spin = DVec3::new(0.1, 0.0, 1e-3);
    let refused = Blocks::new(Setup {
        period: along_x(2.0),
        ..setup(vec![block], joint(3e7, 30.0))
    });
    let expected = "it turns only about x, and its spin is [0.1, 0, 0.001] rad/s";
    assert_contains(refused.unwrap_err(), &[expected]);
}
