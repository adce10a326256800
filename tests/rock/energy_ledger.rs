//! Energy balance: present and dissipated energy add up to the work done on the blocks.

use crate::fixture::{blocks, cuboid, formulas, joint, run, setup, slope};
use glam::{DQuat, DVec3};
use kit::{assert_near, assert_relative};
use riprap::{
    geometry::Load,
    rock::{Block, Motion, Sleep, law::Joint},
};

#[test]
fn blocks_that_tumble_down_a_slope() {
    let turn = slope(35.0);
    let plate = Block::new("plate", cuboid(40.0, 10.0, 1.0), turn * DVec3::Z * -0.5);
    let mut list = vec![plate.fixed().rotated(turn)];
    for i in 0..6 {
        let k = f64::from(i);
        let at = turn * DVec3::new(1.3 * k - 8.0, 0.4 * (2.0 * k).sin(), 1.2 + 0.2 * k);
        let tilt = DQuat::from_scaled_axis(DVec3::new(0.4 * k, 0.3, -0.2 * k));
        list.push(Block::new(format!("{i}"), cuboid(1.0, 0.8, 0.7), at).rotated(tilt));
    }
    let mut setup = setup(list, joint(1e9, 30.0));
    (setup.damping, setup.largest_overlap) = (0.05, 0.3);
    let mut blocks = blocks(setup);
    let start = blocks.ledger();
    run(&mut blocks, 1.5);
    let end = blocks.ledger();
    let error = (end.balance() - start.balance()).abs();
    let fallen = start.potential - end.potential;
    assert!(error < 0.01 * end.dissipated(), "{error} J of {end:?}");
    // Every term contributes, and no dissipative term is negative.
    for (name, work) in [
        ("fallen", fallen),
        ("friction", end.friction),
        ("dashpot", end.dashpot),
        ("mass damping", end.mass_damping),
        ("kinetic", end.kinetic),
    ] {
        assert!(work > 1e-3 * fallen, "{name}: {work} J of {end:?}");
    }
    assert!(end.contact_loss.abs() < 0.05 * fallen, "{end:?}");
}

/// What a block loses when it falls asleep is dissipated.
#[test]
fn blocks_that_fall_asleep() {
    let mut block = Block::new("block", cuboid(1.0, 0.5, 0.7), DVec3::ZERO);
    block.velocity = DVec3::X * 0.01;
    let mut setup = setup(vec![block], joint(1e9, 30.0));
    setup.gravity = DVec3::ZERO;
    setup.time_step = Some(1e-3);
    setup.sleep = Some(Sleep {
        speed: 0.1,
        after: 0.005,
        ..Sleep::default()
    });
    let mut blocks = blocks(setup);
    let start = blocks.ledger();
    run(&mut blocks, 0.01);
    let end = blocks.ledger();
    assert!(blocks.asleep().all(|asleep| asleep));
    assert!(start.kinetic > 0.0 && end.kinetic == 0.0);
    assert_relative(end.dissipated(), start.kinetic, 1e-12);
    assert_relative(end.balance(), start.balance(), 1e-12);
}

/// Without damping and friction the kinetic energy changes by what the springs of changing areas gain or lose.
#[test]
fn edges_that_collide_without_damping_gain_energy_or_lose_it() {
    let mut signs = [false; 2];
    for turn in 0..6 {
        let tilt = DQuat::from_scaled_axis(DVec3::new(0.3, 0.5, 1.0) * f64::from(turn));
        let mut block = Block::new("block", cuboid(1.0, 0.5, 0.7), DVec3::X * -1.2).rotated(tilt);
        block.velocity = DVec3::X * 2.0;
        let other = Block::new("other", cuboid(0.6, 0.6, 0.6), DVec3::new(0.0, 0.2, 0.1));
        let mut setup = setup(
            vec![block, other],
            Joint {
                damping: 0.0,
                ..joint(1e9, 0.0)
            },
        );
        (setup.gravity, setup.largest_overlap) = (DVec3::ZERO, 0.5);
        let mut blocks = blocks(setup);
        let start = blocks.ledger().kinetic;
        run(&mut blocks, 1.5);
        let end = blocks.ledger();
        assert_eq!((end.elastic, end.dashpot, end.friction), (0.0, 0.0, 0.0));
        assert_near(end.kinetic + end.contact_loss, start, 1e-4 * start);
        signs[usize::from(end.contact_loss > 0.0)] |= end.contact_loss.abs() > 1e-3 * start;
    }
    assert_eq!(signs, [true; 2]);
}

#[test]
fn a_driven_block_and_a_load_put_in_what_they_do() {
    let floor = Block::new("floor", cuboid(20.0, 4.0, 1.0), DVec3::Z * -0.5).fixed();
    let mut ram = Block::new("ram", cuboid(1.0, 1.0, 1.0), DVec3::new(-1.0, 0.0, 0.6));
    ram.motion = Motion::Driven {
        velocity: formulas(["0.5*sin(pi*t)", "0", "0"]),
        spin: formulas(["0"; 3]),
    };
    let pushed = Block::new("pushed", cuboid(1.0, 1.0, 1.0), DVec3::new(0.01, 0.0, 0.5));
    let pulled = Block::new("pulled", cuboid(1.0, 1.0, 1.0), DVec3::new(5.0, 0.0, 0.5));
    let mut blocks = blocks(setup(vec![floor, ram, pushed, pulled], joint(1e8, 30.0)));
    let mut loads = [Load::default(); 4];
    // More than the limit of friction: 0.577 of the weight of 24.5 kN.
    loads[3] = Load::at(DVec3::X * 2e4, DVec3::Z * -0.3);
    blocks.set_loads(&loads).expect("one load a block");
    let start = blocks.ledger();
    run(&mut blocks, 1.0);
    let end = blocks.ledger();
    let error = (end.balance() - start.balance()).abs();
    let given = end.driven + end.loads;
    assert!(error < 0.01 * given, "{error} J of {end:?}");
    // The load does work along the displacement of its point of action, here that of the block.
    let way = blocks.poses()[3].centre.x - 5.0;
    assert_relative(end.loads, 2e4 * way, 0.01);
    // The ram moves the block by 1/π m less the gap, against its friction.
    let way = blocks.poses()[2].centre.x - 0.01;
    assert!(end.driven > 0.9 * 0.577 * 2.45e4 * way, "{end:?}, {way} m");
    // (1 − cos πt)/2π.
    let ram = blocks.poses()[1].centre.x + 1.0;
    assert_near(ram * std::f64::consts::PI, 1.0, 1e-6);
    // The ram was fastest in the middle and is at rest at the end; the load pulls one block on.
    let pulled = blocks.poses()[3].velocity.length();
    assert_relative(blocks.peak_speed(), pulled.max(0.5), 1e-6);
}

/// A free block under a load that jumps at every exchange: in a step under a constant force, the block gains exactly
/// the work of the force, so that the total work is the kinetic energy up to rounding.
#[test]
fn a_load_that_jumps_works_from_the_moment_on() {
    let block = Block::new("block", cuboid(1.0, 1.0, 1.0), DVec3::ZERO);
    let mut setup = setup(vec![block], joint(1e8, 30.0));
    (setup.gravity, setup.time_step) = (DVec3::ZERO, Some(1e-3));
    let mut blocks = blocks(setup);
    for (exchange, force) in (1..).zip([1e4, -3e4, 0.0, 7e4, 2e4]) {
        let load = Load::at(DVec3::X * force, DVec3::ZERO);
        blocks.set_loads(&[load]).expect("one load a block");
        run(&mut blocks, f64::from(exchange) * 0.01);
    }
    let end = blocks.ledger();
    assert!(end.kinetic > 1.0, "{end:?}");
    assert_relative(end.loads, end.kinetic, 1e-9);
}
