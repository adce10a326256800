//! What cannot be computed is refused, by name, and leaves the last good state.

use crate::fixture::{AllPairs, blocks, cuboid, joint, setup, try_run};
use glam::{DQuat, DVec3};
use riprap::{
    Error,
    geometry::Load,
    rock::{Block, Blocks, Motion, Setup},
};

fn floor() -> Block {
    Block::new("floor", cuboid(9.0, 9.0, 1.0), DVec3::Z * -0.5).fixed()
}

fn cube(z: f64) -> Block {
    Block::new("cube", cuboid(1.0, 1.0, 1.0), DVec3::Z * z)
}

fn refusal(setup: Setup) -> String {
    Blocks::new(setup)
        .expect_err("it must be refused")
        .to_string()
}

#[test]
fn bad_numbers_are_named() {
    let good = || setup(vec![floor(), cube(0.5)], joint(1e8, 30.0));
    let with = |change: &dyn Fn(&mut Setup)| {
        let mut setup = good();
        change(&mut setup);
        refusal(setup)
    };
    let text = with(&|s| s.materials[0].density = 0.0);
    assert!(text.starts_with("materials[0].density:"), "{text}");
    let text = with(&|s| s.blocks[1].centre.x = f64::NAN);
    assert!(
        text.starts_with("blocks[1] (cube):") && text.contains("centre"),
        "{text}"
    );
    let text = with(&|s| s.blocks[1].rotation = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.5));
    assert!(
        text.starts_with("blocks[1] (cube):") && text.contains("rotation"),
        "{text}"
    );
    let text = with(&|s| s.blocks[1].material = 3);
    assert!(text.contains("there is no material 3"), "{text}");
    let text = with(&|s| s.materials[0].joint.friction_angle = 1.6);
    assert!(text.starts_with("materials[0].friction_angle:"), "{text}");
    let text = with(&|s| s.time_step = Some(-1.0));
    assert!(text.starts_with("time_step:"), "{text}");
}

#[test]
fn blocks_that_overlap_at_the_start_are_listed_and_can_be_relaxed() {
    let list = vec![
        floor(),
        cube(0.45),
        Block::new("upper", cuboid(1.0, 1.0, 1.0), DVec3::Z * 1.2),
    ];
    let mut blocks = blocks(setup(list, joint(1e8, 30.0)));
    let Err(Error::Overlaps { pairs }) = try_run(&mut blocks, 0.1) else {
        panic!("overlaps must be refused");
    };
    let named: Vec<_> = pairs
        .iter()
        .map(|p| (p.first.as_str(), p.second.as_str()))
        .collect();
    let cube_name = "blocks[1] (cube)";
    assert_eq!(
        named,
        [
            (cube_name, "blocks[2] (upper)"),
            ("blocks[0] (floor)", cube_name)
        ]
    );
    assert!((pairs[0].depth - 0.25).abs() < 1e-9 && (pairs[1].depth - 0.05).abs() < 1e-9);

    let sweeps = pollster::block_on(blocks.relax(&mut AllPairs, 100)).expect("they go apart");
    assert!(sweeps > 1);
    try_run(&mut blocks, 0.05).expect("nothing overlaps by more than 1 % now");
    let [_, lower, upper] = blocks.poses()[..] else {
        panic!("three blocks")
    };
    assert!(
        lower.centre.z > 0.49 && upper.centre.z > 1.48,
        "{lower:?} {upper:?}"
    );
    assert!(blocks.largest_speed() < 1.0);
}

#[test]
fn a_step_too_long_for_the_stiffness_is_refused_with_the_bound() {
    let mut long = setup(vec![floor(), cube(0.499)], joint(1e8, 30.0));
    long.time_step = Some(0.01);
    let mut refused = blocks(long.clone());
    let before = postcard::to_allocvec(&refused.snapshot()).unwrap().len();
    let Err(Error::TimeStep {
        requested,
        bound,
        usual,
        block,
    }) = try_run(&mut refused, 0.1)
    else {
        panic!("the step must be refused");
    };
    // Σ(k_n+k_s)A (|r|² + w²/4)/I_min governs: r = ½ m, w = √2 m, I = m/6 of 2500 kg.
    let omega = (2.0f64 * 2e8 * 0.75 / (2500.0 / 6.0)).sqrt();
    assert_eq!(requested, 0.01);
    assert!((bound / (0.2 * 2.0 / omega) - 1.0).abs() < 0.01, "{bound}");
    assert!((usual / bound - 0.5).abs() < 1e-12);
    assert_eq!(block, "blocks[1] (cube)");
    assert_eq!(refused.time(), 0.0);
    assert!(postcard::to_allocvec(&refused.snapshot()).unwrap().len() >= before);

    long.time_step = Some(0.99 * bound);
    try_run(&mut blocks(long), 0.1).expect("just below the bound");
}

#[test]
fn a_ram_that_crushes_a_block_is_refused_and_the_last_good_state_is_kept() {
    let mut ram = Block::new("ram", cuboid(1.0, 1.0, 1.0), DVec3::Z * 1.51);
    let formula = |text: &str| text.parse().expect("a formula");
    ram.motion = Motion::Driven {
        velocity: [formula("0"), formula("0"), formula("-1")],
        spin: [formula("0"), formula("0"), formula("0")],
    };
    let mut blocks = blocks(setup(vec![floor(), cube(0.5), ram], joint(1e7, 30.0)));
    let error = try_run(&mut blocks, 1.0).expect_err("it must be refused");
    let Error::DeepOverlap {
        first,
        second,
        depth,
        limit,
        ..
    } = &error
    else {
        panic!("{error}");
    };
    assert!(
        first.starts_with("blocks[") && second.starts_with("blocks["),
        "{error}"
    );
    assert!(depth > limit && (limit - 0.05).abs() < 1e-9, "{error}");
    // Faces are as stiff as they are.
    assert!(!error.to_string().contains("corner_area"), "{error}");
    // The step before it did not crush: the state is that of its end.
    let deepest = blocks.contacts().map(|c| c.overlap).fold(0.0, f64::max);
    assert!(deepest > 0.04 && deepest <= *limit, "{deepest}");
    let time = blocks.time();
    let before = blocks.snapshot();
    assert!(blocks.step().is_err());
    assert_eq!(blocks.snapshot(), before);
    assert_eq!(blocks.time(), time);
}

#[test]
fn a_load_that_is_no_number_is_refused_and_one_that_throws_a_block_away_is_found() {
    let mut blocks = blocks(setup(vec![floor(), cube(0.5)], joint(1e8, 30.0)));
    let mut loads = [Load::default(); 2];
    loads[1].force.x = f64::NAN;
    let text = blocks.load(&loads).expect_err("NaN").to_string();
    assert!(text.starts_with("blocks[1] (cube):"), "{text}");
    assert!(blocks.load(&loads[..1]).is_err());

    loads[1].force.x = f64::MAX;
    blocks.load(&loads).expect("a number");
    let Err(Error::NotFinite { block, .. }) = try_run(&mut blocks, 0.1) else {
        panic!("the block is nowhere");
    };
    assert_eq!(block, "blocks[1] (cube)");
    assert!(blocks.poses().iter().all(|pose| pose.centre.is_finite()));
}

#[test]
fn pairs_that_are_none_are_refused() {
    let mut blocks = blocks(setup(vec![floor(), cube(0.5)], joint(1e8, 30.0)));
    assert!(blocks.step().is_err(), "pairs first");
    for bad in [vec![[1, 0]], vec![[0, 2]], vec![[0, 1], [0, 1]]] {
        assert!(blocks.set_pairs(bad).is_err());
    }
    blocks.set_pairs(vec![[0, 1]]).expect("the pair");
    blocks.step().expect("now it runs");
}

#[test]
fn a_drive_without_a_value_names_its_formula_and_the_time() {
    let mut block = Block::new("ram", cuboid(1.0, 1.0, 1.0), DVec3::ZERO);
    let formula = |text: &str| text.parse().expect("a formula");
    block.motion = Motion::Driven {
        velocity: [formula("0.1*sqrt(0.02 - t)"), formula("0"), formula("0")],
        spin: Default::default(),
    };
    let mut blocks = blocks(Setup {
        time_step: Some(1e-3),
        ..setup(vec![block], joint(1e8, 30.0))
    });
    let text = try_run(&mut blocks, 0.1).expect_err("a root of less than nothing");
    let text = text.to_string();
    for part in ["ram", "0.1*sqrt(0.02 - t)", "t = 0.02"] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

/// A cube above a floor, in steps that are too long to see it.
#[test]
fn a_block_that_would_fall_through_another_within_a_step_is_refused() {
    let falling = |dt: f64, velocity: f64| {
        let mut cube = cube(2.5);
        cube.velocity.z = velocity;
        let mut setup = setup(vec![floor(), cube], joint(1e8, 30.0));
        setup.time_step = Some(dt);
        blocks(setup)
    };
    // Driven by gravity alone from rest, ½ g Δt² in the first step.
    let mut long = falling(1.0, 0.0);
    let text = try_run(&mut long, 3.0).expect_err("a leap").to_string();
    for part in ["blocks[1] (cube):", "4.905e0 m in a step", "of at most"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert_eq!((long.time(), long.poses()[1].centre.z), (0.0, 2.5));
    let text = try_run(&mut falling(1e-4, -1e5), 0.01).expect_err("a bullet");
    assert!(text.to_string().contains("1.000e5 m/s"), "{text}");
    // Steps that see the floor end at it, one way or the other.
    for dt in [0.1, 0.01] {
        assert!(try_run(&mut falling(dt, 0.0), 3.0).is_err(), "{dt}");
    }
    // There is nothing that it could pass through.
    let mut alone = setup(vec![cube(2.5)], joint(1e8, 30.0));
    alone.time_step = Some(1.0);
    try_run(&mut blocks(alone), 3.0).expect("free fall");
}

#[test]
fn times_that_are_past_or_none_are_refused() {
    let mut blocks = blocks(setup(vec![floor(), cube(1.5)], joint(1e8, 30.0)));
    try_run(&mut blocks, 0.01).expect("it falls");
    let before = blocks.snapshot();
    for until in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let text = try_run(&mut blocks, until).expect_err("no time");
        assert!(text.to_string().starts_with("until: "), "{text}");
        assert!(blocks.step_towards(until).is_err());
        assert!(blocks.wait(until).is_err());
    }
    let text = blocks.step_towards(0.005).expect_err("it is past");
    assert!(text.to_string().contains("0.005 s is past"), "{text}");
    try_run(&mut blocks, 0.005).expect("nothing is left to do");
    assert_eq!(blocks.snapshot(), before);
}

#[test]
fn a_block_that_is_not_there_has_no_numbers() {
    let blocks = blocks(setup(vec![floor(), cube(0.5)], joint(1e8, 30.0)));
    assert_eq!((blocks.name(2), blocks.moves(2)), ("", false));
    assert!(blocks.mass(2).is_nan() && blocks.rotation(2).is_nan());
    assert!(blocks.angular_momentum(2).is_nan());
}
