//! Blocks that cannot deform are refused by name, and so are steps too long for those that can.

use crate::fixture::{blocks, cuboid, joint, setup, try_run};
use glam::{DMat3, DVec3};
use riprap::{
    Error,
    geometry::{Form, Part, Polyhedron, Shape},
    rock::{Block, Blocks, Deformable, FixedPoint, PointLoad, Setup, law::Elastic},
};

fn elastic(block: Block) -> Setup {
    let mut setup = setup(vec![block], joint(1e8, 30.0));
    setup.materials[0].elastic = Some(Elastic {
        youngs_modulus: 1e9,
        poissons_ratio: 0.25,
    });
    setup
}

fn cube() -> Block {
    Block::new("cube", cuboid(1.0, 1.0, 1.0), DVec3::ZERO).deformable()
}

fn refusal(setup: Setup) -> String {
    let refused = Blocks::new(setup).expect_err("it must be refused");
    refused.to_string()
}

#[test]
fn what_cannot_deform_is_named() {
    let ball = Shape::sphere(0.5).expect("a ball");
    let text = refusal(elastic(Block {
        shape: ball.into(),
        ..cube()
    }));
    assert!(
        text.starts_with("blocks[0] (cube):") && text.contains("sphere"),
        "{text}"
    );
    let part = |x: f64| Part {
        form: Form::Convex(Polyhedron::cuboid(DVec3::ONE).expect("a cube")),
        offset: DVec3::X * x,
    };
    let (two, _) = Shape::compound(vec![part(0.0), part(1.0)]).expect("two cubes");
    let text = refusal(elastic(Block {
        shape: two.into(),
        ..cube()
    }));
    assert!(text.contains("compound of 2 parts"), "{text}");
    let text = refusal(elastic(cube().fixed()));
    assert!(text.contains("fixed points"), "{text}");
    let mut rigid = elastic(cube());
    rigid.materials[0].elastic = None;
    let text = refusal(rigid);
    assert!(text.contains("Young's modulus"), "{text}");
    for (young, ratio, name) in [(0.0, 0.25, "youngs_modulus"), (1e9, 0.5, "poissons_ratio")] {
        let mut bad = elastic(cube());
        bad.materials[0].elastic = Some(Elastic {
            youngs_modulus: young,
            poissons_ratio: ratio,
        });
        let text = refusal(bad);
        assert!(text.starts_with(&format!("materials[0].{name}:")), "{text}");
    }
    let stressed = Deformable {
        initial_stress: DMat3::from_cols(DVec3::Y, DVec3::ZERO, DVec3::ZERO),
        ..Deformable::default()
    };
    let text = refusal(elastic(Block {
        deformable: Some(stressed),
        ..cube()
    }));
    assert!(text.contains("symmetric"), "{text}");
    let held = Deformable {
        fixed_points: vec![FixedPoint {
            point: DVec3::X,
            axes: [false, true, false],
        }],
        ..Deformable::default()
    };
    let text = refusal(elastic(Block {
        deformable: Some(held),
        spin: DVec3::Z,
        ..cube()
    }));
    assert!(
        text.contains("fixed point 0") && text.contains("at rest"),
        "{text}"
    );
    let mut pulled = cube().fixed();
    pulled.deformable = None;
    pulled.point_loads = vec![PointLoad {
        point: DVec3::ZERO,
        force: ["1", "0", "0"].map(|f| f.parse().expect("a formula")),
    }];
    let text = refusal(elastic(pulled));
    assert!(text.contains("free blocks"), "{text}");
}

#[test]
fn a_step_too_long_for_the_elasticity_is_refused_with_the_bound() {
    let mut long = elastic(cube());
    // 2/ω = a/√(3(3λ + 2μ)/ρ) with λ = μ = 0.4 GPa.
    let critical = 1.0 / (3.0 * 5.0 * 4e8 / 2500.0f64).sqrt();
    long.time_step = Some(0.201 * critical);
    let mut refused = blocks(long.clone());
    let Err(Error::TimeStep { bound, usual, .. }) = try_run(&mut refused, 0.1) else {
        panic!("the step must be refused");
    };
    assert!((bound / (0.2 * critical) - 1.0).abs() < 1e-9, "{bound}");
    assert!((usual / bound - 0.5).abs() < 1e-12);
    assert_eq!(refused.time(), 0.0);

    long.time_step = Some(0.199 * critical);
    try_run(&mut blocks(long.clone()), 0.1).expect("just below the bound");
    long.time_step = None;
    let usual = blocks(long).time_step();
    // Half of the largest, less what contacts on its faces would take.
    assert!(usual < 0.1 * critical && usual > 0.05 * critical, "{usual}");
}

#[test]
fn a_block_that_is_crushed_is_named_and_the_last_state_is_kept() {
    let mut block = cube();
    // Ten times Young's modulus on each face.
    let crush = |x: f64, f: &str| PointLoad {
        point: DVec3::X * x,
        force: [f, "0", "0"].map(|f| f.parse().expect("a formula")),
    };
    block.point_loads = vec![crush(0.5, "-1e10"), crush(-0.5, "1e10")];
    let mut setup = elastic(block);
    setup.time_step = Some(1e-5);
    let mut blocks = blocks(setup);
    let error = loop {
        if blocks.wants_pairs() {
            blocks.set_pairs(Vec::new()).expect("it is alone");
        }
        if let Err(error) = blocks.step() {
            break error;
        }
        assert!(blocks.time() < 0.1, "nothing was refused");
    };
    // Under strain the block stiffens; whichever limit comes first names it.
    let text = error.to_string();
    assert!(text.contains("blocks[0] (cube)"), "{text}");
    assert!(
        matches!(error, Error::Inverted { .. } | Error::TimeStep { .. }),
        "{text}"
    );
    assert!(blocks.poses()[0].deformation.determinant() > 0.0);
}
