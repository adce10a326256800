//! Invalid input is refused with an error that names it, and the last valid state is kept.

use crate::fixture::{blocks, cube, floor, formulas, joint, setup, try_run};
use glam::{DQuat, DVec3};
use kit::{assert_contains, assert_near, assert_relative};
use riprap::{
    Error,
    geometry::{Form, Load, Part, Polyhedron, Shape},
    rock::{
        Blocks, Deformable, FixedPoint, Motion, PointLoad, Setup, broadphase::HostBroadphase,
        law::Elastic,
    },
};

/// A cube on a floor.
fn resting() -> Setup {
    setup(vec![floor(), cube("cube", 0.5)], joint(1e8, 30.0))
}

/// A cube that deforms.
fn elastic() -> Setup {
    let mut setup = setup(vec![cube("cube", 0.0).deformable()], joint(1e8, 30.0));
    setup.materials[0].elastic = Some(Elastic {
        youngs_modulus: 1e9,
        poissons_ratio: 0.25,
    });
    setup
}

/// Error messages of the changed setups, one line per change.
fn refusals(good: fn() -> Setup, changes: &[fn(&mut Setup)]) -> String {
    let refusal = |change: &fn(&mut Setup)| {
        let mut setup = good();
        change(&mut setup);
        Blocks::new(setup)
            .expect_err("it must be refused")
            .to_string()
            + "\n"
    };
    changes.iter().map(refusal).collect()
}

#[test]
fn bad_numbers_are_named() {
    insta::assert_snapshot!(refusals(
        resting,
        &[
            |s| s.materials[0].density = 0.0,
            |s| s.blocks[1].centre.x = f64::NAN,
            |s| s.blocks[1].rotation = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.5),
            |s| s.blocks[1].material = 3,
            |s| s.materials[0].joint.friction_angle = 1.6,
            |s| s.time_step = Some(-1.0),
        ],
    ));
}

/// Spheres, compounds, fixed blocks, rock without elasticity, and deformations that contradict themselves.
#[test]
fn what_cannot_deform_is_named() {
    fn deformable(setup: &mut Setup) -> &mut Deformable {
        setup.blocks[0].deformable.as_mut().expect("it deforms")
    }
    insta::assert_snapshot!(refusals(
        elastic,
        &[
            |s| s.blocks[0].shape = Shape::sphere(0.5).expect("a ball").into(),
            |s| {
                let part = |x: f64| Part {
                    form: Form::Convex(Polyhedron::cuboid(DVec3::ONE).expect("a cube")),
                    offset: DVec3::X * x,
                };
                let two = Shape::compound(vec![part(0.0), part(1.0)]);
                s.blocks[0].shape = two.expect("two cubes").0.into();
            },
            |s| s.blocks[0].motion = Motion::Fixed,
            |s| s.materials[0].elastic = None,
            |s| s.materials[0]
                .elastic
                .as_mut()
                .expect("elastic")
                .youngs_modulus = 0.0,
            |s| s.materials[0]
                .elastic
                .as_mut()
                .expect("elastic")
                .poissons_ratio = 0.5,
            |s| deformable(s).initial_stress.x_axis = DVec3::Y,
            |s| {
                deformable(s).fixed_points = vec![FixedPoint {
                    point: DVec3::X,
                    axes: [false, true, false],
                }];
                s.blocks[0].spin = DVec3::Z;
            },
            |s| {
                s.blocks[0].deformable = None;
                s.blocks[0].motion = Motion::Fixed;
                s.blocks[0].point_loads = vec![PointLoad {
                    point: DVec3::ZERO,
                    force: formulas(["1", "0", "0"]),
                }];
            },
        ],
    ));
}

#[test]
fn blocks_that_overlap_at_the_start_are_listed_and_can_be_relaxed() {
    let list = vec![floor(), cube("cube", 0.45), cube("upper", 1.2)];
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

    let sweeps = pollster::block_on(blocks.relax(&mut HostBroadphase, 100)).expect("they go apart");
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
fn relaxed_blocks_are_not_thrown_apart() {
    let mut setup = setup(
        vec![cube("one", 0.45), cube("other", 1.35)],
        joint(1e10, 30.0),
    );
    setup.gravity = DVec3::ZERO;
    let mut blocks = blocks(setup);
    pollster::block_on(blocks.relax(&mut HostBroadphase, 100)).unwrap();
    try_run(&mut blocks, 0.05).unwrap();
    // Springs at the largest overlap that is allowed at the start would throw them at 2.3 m/s.
    assert!(blocks.peak_speed() < 0.01, "{}", blocks.peak_speed());
}

/// Their contact has no normal.
#[test]
fn blocks_with_the_same_centre_go_apart() {
    let mut blocks = blocks(setup(
        vec![cube("one", 0.5), cube("other", 0.5)],
        joint(1e8, 30.0),
    ));
    pollster::block_on(blocks.relax(&mut HostBroadphase, 100)).unwrap();
    let [one, other] = blocks.poses()[..] else {
        panic!("two blocks")
    };
    let apart = one.centre - other.centre;
    assert!(apart.is_finite() && apart.length() > 0.98, "{apart}");
}

#[test]
fn a_step_too_long_for_the_stiffness_is_refused_with_the_bound() {
    let mut long = setup(vec![floor(), cube("cube", 0.499)], joint(1e8, 30.0));
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
    assert_relative(bound, 0.2 * 2.0 / omega, 0.01);
    assert_near(usual / bound, 0.5, 1e-12);
    assert_eq!(block, "blocks[1] (cube)");
    assert_eq!(refused.time(), 0.0);
    assert!(postcard::to_allocvec(&refused.snapshot()).unwrap().len() >= before);

    long.time_step = Some(0.99 * bound);
    try_run(&mut blocks(long), 0.1).expect("just below the bound");
}

#[test]
fn a_ram_that_crushes_a_block_is_refused_and_the_last_good_state_is_kept() {
    let mut ram = cube("ram", 1.51);
    ram.motion = Motion::Driven {
        velocity: formulas(["0", "0", "-1"]),
        spin: Default::default(),
    };
    let mut blocks = blocks(setup(
        vec![floor(), cube("cube", 0.5), ram],
        joint(1e7, 30.0),
    ));
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
    // For a face contact, the error does not suggest a corner area.
    assert!(!error.to_string().contains("corner_area"), "{error}");
    // The previous step was still accepted: the state is that at its end.
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
    let mut blocks = blocks(resting());
    let mut loads = [Load::default(); 2];
    loads[1].force.x = f64::NAN;
    let text = blocks.set_loads(&loads).expect_err("NaN").to_string();
    assert!(text.starts_with("blocks[1] (cube):"), "{text}");
    assert!(blocks.set_loads(&loads[..1]).is_err());

    loads[1].force.x = f64::MAX;
    blocks.set_loads(&loads).expect("a number");
    let Err(Error::NotFinite { block, .. }) = try_run(&mut blocks, 0.1) else {
        panic!("the block is nowhere");
    };
    assert_eq!(block, "blocks[1] (cube)");
    assert!(blocks.poses().iter().all(|pose| pose.centre.is_finite()));
}

#[test]
fn pairs_that_are_none_are_refused() {
    let mut blocks = blocks(resting());
    assert!(blocks.step().is_err(), "pairs first");
    for bad in [vec![[1, 0]], vec![[0, 2]], vec![[0, 1], [0, 1]]] {
        assert!(blocks.set_pairs(bad).is_err());
    }
    blocks.set_pairs(vec![[0, 1]]).expect("the pair");
    blocks.step().expect("now it runs");
}

#[test]
fn an_acceleration_without_a_value_names_its_formula_and_the_time() {
    let mut block = cube("pushed", 0.0);
    block.acceleration = Some(formulas(["1/max(0, 0.05 - t)", "0", "0"]));
    let mut blocks = blocks(Setup {
        time_step: Some(1e-3),
        ..setup(vec![block], joint(1e8, 30.0))
    });
    let error = try_run(&mut blocks, 0.1).unwrap_err();
    assert!((blocks.time() - 0.05).abs() < 2e-3, "{}", blocks.time());
    assert_contains(error, &["blocks[0] (pushed)", "`1/max(0, 0.05 - t)`"]);
}

#[test]
fn a_drive_without_a_value_names_its_formula_and_the_time() {
    let mut block = cube("ram", 0.0);
    block.motion = Motion::Driven {
        velocity: formulas(["0.1*sqrt(0.02 - t)", "0", "0"]),
        spin: Default::default(),
    };
    let mut blocks = blocks(Setup {
        time_step: Some(1e-3),
        ..setup(vec![block], joint(1e8, 30.0))
    });
    let text = try_run(&mut blocks, 0.1).expect_err("a root of less than nothing");
    let text = text.to_string();
    assert_contains(&text, &["ram", "0.1*sqrt(0.02 - t)", "t = 0.02"]);
}

/// A cube above a floor, with steps that are too long to detect the floor.
#[test]
fn a_block_that_would_fall_through_another_within_a_step_is_refused() {
    let falling = |dt: f64, velocity: f64| {
        let mut cube = cube("cube", 2.5);
        cube.velocity.z = velocity;
        let mut setup = setup(vec![floor(), cube], joint(1e8, 30.0));
        setup.time_step = Some(dt);
        blocks(setup)
    };
    let mut bullet = falling(1e-4, -1e5);
    let text = try_run(&mut bullet, 0.01)
        .expect_err("a bullet")
        .to_string();
    for part in [
        "blocks[1] (cube):",
        "1.000e5 m/s",
        "in a step",
        "of at most",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert_eq!((bullet.time(), bullet.poses()[1].centre.z), (0.0, 2.5));
    // Steps longer than its contacts will allow leap through the floor, or reach it with a deep overlap.
    for dt in [1.0, 0.1, 0.01] {
        let error = try_run(&mut falling(dt, 0.0), 3.0).expect_err("a long step");
        assert!(matches!(error, Error::TimeStep { .. }), "{error}");
    }
    // Without other blocks there is no limit.
    let mut alone = setup(vec![cube("cube", 2.5)], joint(1e8, 30.0));
    alone.time_step = Some(1.0);
    try_run(&mut blocks(alone), 3.0).expect("free fall");
}

#[test]
fn times_that_are_past_or_none_are_refused() {
    let mut blocks = blocks(setup(vec![floor(), cube("cube", 1.5)], joint(1e8, 30.0)));
    try_run(&mut blocks, 0.01).expect("it falls");
    let before = blocks.snapshot();
    for until in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let text = try_run(&mut blocks, until).expect_err("no time");
        assert!(text.to_string().starts_with("until: "), "{text}");
        assert!(blocks.step_towards(until).is_err());
        assert!(blocks.skip_to(until).is_err());
    }
    let text = blocks.step_towards(0.005).expect_err("it is past");
    assert!(text.to_string().contains("0.005 s is past"), "{text}");
    try_run(&mut blocks, 0.005).expect("nothing is left to do");
    assert_eq!(blocks.snapshot(), before);
}

#[test]
fn a_block_that_is_not_there_has_no_numbers() {
    let blocks = blocks(resting());
    assert_eq!((blocks.name(2), blocks.moves(2)), ("", false));
    assert!(blocks.mass(2).is_nan() && blocks.rotation(2).is_nan());
    assert!(blocks.angular_momentum(2).is_nan());
}

#[test]
fn a_step_too_long_for_the_elasticity_is_refused_with_the_bound() {
    let mut long = elastic();
    // 2/ω = a/√(3(3λ + 2μ)/ρ) with λ = μ = 0.4 GPa.
    let critical = 1.0 / (3.0 * 5.0 * 4e8 / 2500.0f64).sqrt();
    long.time_step = Some(0.201 * critical);
    let mut refused = blocks(long.clone());
    let Err(Error::TimeStep { bound, usual, .. }) = try_run(&mut refused, 0.1) else {
        panic!("the step must be refused");
    };
    assert_relative(bound, 0.2 * critical, 1e-9);
    assert_near(usual / bound, 0.5, 1e-12);
    assert_eq!(refused.time(), 0.0);

    long.time_step = Some(0.199 * critical);
    try_run(&mut blocks(long.clone()), 0.1).expect("just below the bound");
    long.time_step = None;
    let usual = blocks(long).time_step();
    // Half of the largest step, less the share of the assumed contacts on its faces.
    assert!(usual < 0.1 * critical && usual > 0.05 * critical, "{usual}");
}

#[test]
fn a_block_that_is_crushed_is_named_and_the_last_state_is_kept() {
    // Ten times Young's modulus on each face.
    let crush = |x: f64, f: &str| PointLoad {
        point: DVec3::X * x,
        force: formulas([f, "0", "0"]),
    };
    let mut setup = elastic();
    setup.blocks[0].point_loads = vec![crush(0.5, "-1e10"), crush(-0.5, "1e10")];
    setup.time_step = Some(1e-5);
    let mut blocks = blocks(setup);
    let error = loop {
        if blocks.needs_pairs() {
            blocks.set_pairs(Vec::new()).expect("it is alone");
        }
        if let Err(error) = blocks.step() {
            break error;
        }
        assert!(blocks.time() < 0.1, "nothing was refused");
    };
    // Under strain the block stiffens; whichever limit is reached first, the error names the block.
    let text = error.to_string();
    assert!(text.contains("blocks[0] (cube)"), "{text}");
    assert!(
        matches!(error, Error::Inverted { .. } | Error::TimeStep { .. }),
        "{text}"
    );
    assert!(blocks.poses()[0].deformation.determinant() > 0.0);
}
