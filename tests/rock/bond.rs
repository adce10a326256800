//! Bonds: faces that touch at the start carry tension up to σ_t, in the middle or at the edge, and break permanently.

use crate::fixture::{assert_restarts, blocks, cuboid, formulas, run, setup};
use glam::DVec3;
use kit::assert_relative;
use riprap::{
    geometry::{HalfSpace, Polyhedron},
    rock::{Block, Blocks, PairMaterial, PointLoad, Setup, Sleep, law::Joint},
};
use std::{
    f64::consts::{PI, TAU},
    sync::Arc,
};

/// Weight of the hanging block, N: 0.2 × 0.3 × 0.1 m of 2500 kg/m³.
const WEIGHT: f64 = 0.006 * 2500.0 * 9.81;
const AREA: f64 = 0.06;

fn tensile(strength: f64) -> Joint {
    Joint {
        tensile_strength: strength,
        damping: 0.3,
        ..Joint::default()
    }
}

/// A block under a ceiling, which it overlaps by `overlap` (m), without gravity.
fn hanging(joint: Joint, overlap: f64) -> Setup {
    let ceiling = Block::new("ceiling", cuboid(1.0, 1.0, 0.2), DVec3::Z * 0.1).fixed();
    let at = DVec3::Z * (overlap - 0.05);
    let block = Block::new("block", cuboid(0.2, 0.3, 0.1), at);
    let mut setup = setup(vec![ceiling, block], joint);
    setup.gravity = DVec3::ZERO;
    setup
}

/// Applies the weight smoothly within 0.2 s, so that the load does not overshoot.
fn slowly(setup: &mut Setup) {
    for block in &mut setup.blocks[1..] {
        block.acceleration = Some(formulas(["0", "0", "-9.81*sin(pi/2*min(1,t/0.2))^2"]));
    }
}

/// Distance by which the block `block` sinks in 0.4 s, m.
fn sunk(setup: Setup, block: usize) -> f64 {
    let mut blocks = blocks(setup);
    let start = blocks.poses()[block].centre.z;
    run(&mut blocks, 0.4);
    start - blocks.poses()[block].centre.z
}

/// W/A = σ_t; the bond opens by W/(k_n A).
#[test]
fn a_block_hangs_up_to_its_tensile_strength() {
    for overlap in [0.0, 1e-8] {
        let of = |share: f64| {
            let mut setup = hanging(tensile(share * WEIGHT / AREA), overlap);
            slowly(&mut setup);
            sunk(setup, 1)
        };
        let open = of(1.02);
        let exact = WEIGHT / (1e9 * AREA) + overlap;
        assert_relative(open, exact, 1e-3);
        let fallen = of(0.98);
        assert!(fallen > 1e-3, "{fallen} m");
    }
    // An initial overlap that pushes the block down with four times its weight.
    let thrown = sunk(
        Setup {
            gravity: DVec3::Z * -9.81,
            ..hanging(tensile(1e5), 1e-5)
        },
        1,
    );
    assert!(thrown < 2e-5, "{thrown} m");
}

/// The lower of two blocks hangs on the upper one by a weaker bond.
#[test]
fn a_chain_breaks_in_the_middle() {
    let of = |share: f64| {
        let mut setup = hanging(tensile(1e5), 0.0);
        let at = DVec3::Z * -0.15;
        setup
            .blocks
            .push(Block::new("lower", cuboid(0.2, 0.3, 0.1), at));
        setup.materials.push(setup.materials[0]);
        for block in &mut setup.blocks[1..] {
            block.material = 1;
        }
        setup.pairs.push(PairMaterial {
            materials: [1, 1],
            joint: tensile(share * WEIGHT / AREA),
        });
        slowly(&mut setup);
        [1, 2].map(|block| sunk(setup.clone(), block))
    };
    let open = WEIGHT / (1e9 * AREA);
    let [upper, lower] = of(1.02);
    assert_relative(upper, 2.0 * open, 1e-3);
    assert_relative(lower, 3.0 * open, 1e-3);
    let [upper, lower] = of(0.98);
    assert!(upper < 3.0 * open && lower > 1e-3, "{upper} m {lower} m");
}

/// A block bonded to a wall: the moment W a/2 over b h²/6 is the tension at the upper edge, 3 W a/(b h²), a the
/// length, b the width, h the height. Cohesion carries the shear.
#[test]
fn a_cantilever_breaks_by_the_tension_at_its_edge() {
    let strength = 3.0 * WEIGHT * 0.2 / (0.3 * 0.01);
    let of = |share: f64| {
        let joint = Joint {
            cohesion: 1e6,
            ..tensile(share * strength)
        };
        let wall = Block::new("wall", cuboid(0.2, 1.0, 1.0), DVec3::X * -0.1).fixed();
        let block = Block::new("block", cuboid(0.2, 0.3, 0.1), DVec3::X * 0.1);
        let mut setup = setup(vec![wall, block], joint);
        setup.gravity = DVec3::ZERO;
        slowly(&mut setup);
        sunk(setup, 1)
    };
    // The displacement of the shear spring, and the rotation W a/2/(k_n b h³/12) times half of a.
    let exact = WEIGHT / (1e9 * 0.03) + WEIGHT * 0.1 / (1e9 * 0.3 * 1e-3 / 12.0) * 0.1;
    let held = of(1.02);
    assert_relative(held, exact, 0.01);
    let fallen = of(0.98);
    assert!(fallen > 1e-3, "{fallen} m");
}

/// A block bonded by a face whose principal moments are equal, turned about its axis: the strength is that of the corner
/// farthest from the neutral axis. The face has `corners` corners at `radius`.
#[test]
fn the_strength_of_a_regular_patch_is_that_of_its_farthest_corner() {
    const LENGTH: f64 = 0.3;
    for (corners, angles) in [(4, [0.0, 10.0, 45.0]), (6, [0.0, 20.0, 30.0])] {
        for angle in angles {
            let radius = 0.1;
            let n = f64::from(corners);
            let at = |k: f64| {
                DVec3::X
                    .cross(DVec3::Y)
                    .rotate_x(f64::to_radians(angle) + TAU * k / n)
            };
            let side = |k: i32| {
                let normal = at(f64::from(k) + 0.5);
                HalfSpace::through(radius * (PI / n).cos() * normal, normal)
            };
            let ends = [-DVec3::X, DVec3::X].map(|x| HalfSpace::through(0.5 * LENGTH * x, x));
            let faces: Vec<HalfSpace> = (0..corners).map(side).chain(ends).collect();
            let (shape, _) = Polyhedron::from_half_spaces(&faces).unwrap();
            let area = 0.5 * n * radius * radius * (TAU / n).sin();
            // ∫ z² dA of a regular polygon.
            let second = n / 24.0 * radius.powi(4) * (TAU / n).sin() * (2.0 + (TAU / n).cos());
            let heights = (0..corners).map(|k| radius * at(f64::from(k)).z);
            let farthest = heights.fold(0.0, f64::max);
            let weight = area * LENGTH * 2500.0 * 9.81;
            let strength = weight * 0.5 * LENGTH * farthest / second;
            let sunk = |share: f64| {
                let joint = Joint {
                    cohesion: 1e6,
                    ..tensile(share * strength)
                };
                let wall = Block::new("wall", cuboid(0.2, 1.0, 1.0), DVec3::X * -0.1).fixed();
                let block = Block::new(
                    "block",
                    Arc::new(shape.clone().into()),
                    DVec3::X * 0.5 * LENGTH,
                );
                let mut setup = setup(vec![wall, block], joint);
                setup.gravity = DVec3::ZERO;
                slowly(&mut setup);
                sunk(setup, 1)
            };
            let [held, fallen] = [1.02, 0.98].map(sunk);
            assert!(
                held < 1e-3 && fallen > 1e-2,
                "{corners} {angle}: {held} m {fallen} m"
            );
        }
    }
}

/// A load that tears the block off at 5 kPa, presses it back, and pulls with half of that stress.
fn torn() -> Blocks {
    let mut setup = hanging(tensile(5e3), 0.0);
    setup.blocks[1].point_loads = vec![PointLoad {
        point: DVec3::ZERO,
        force: formulas([
            "0",
            "0",
            "-1000*t*(1+sign(0.16-t)) + 30*(sign(t-0.16)+sign(0.5-t)) - 75*(1+sign(t-0.5))",
        ]),
    }];
    blocks(setup)
}

#[test]
fn energy_adds_up_over_stretching_and_breaking() {
    let mut blocks = torn();
    let start = blocks.ledger();
    run(&mut blocks, 0.149);
    let stretched = blocks.ledger();
    // ½F²/(k_n A) at 298 N.
    let held = 0.5 * 298f64.powi(2) / (1e9 * AREA);
    assert_relative(stretched.elastic, held, 0.01);
    assert!(blocks.contacts().all(|contact| contact.bonded));
    run(&mut blocks, 0.155);
    let end = blocks.ledger();
    assert_eq!(blocks.contacts().count(), 0);
    let released = 0.5 * 300f64.powi(2) / (1e9 * AREA);
    assert_relative(end.contact_loss, released, 0.02);
    let error = (end.balance() - start.balance()).abs();
    assert!(error < 0.01 * released, "{error} J of {end:?}");
}

#[test]
fn what_broke_does_not_hold_again() {
    let mut blocks = torn();
    run(&mut blocks, 0.5);
    assert!(blocks.contacts().any(|contact| contact.force.z < 0.0));
    assert!(blocks.contacts().all(|contact| !contact.bonded));
    run(&mut blocks, 0.6);
    let at = blocks.poses()[1].centre.z;
    assert!(at < -0.06, "{at} m");
}

#[test]
fn a_restart_goes_on_with_the_same_bits() {
    let mut setup = hanging(tensile(1.02 * WEIGHT / AREA), 0.0);
    slowly(&mut setup);
    let whole = assert_restarts(&setup, 0.06, 0.15);
    assert!(whole.contacts().all(|contact| contact.bonded));
}

#[test]
fn a_sleeper_hangs_on() {
    let mut setup = hanging(tensile(1e4), 0.0);
    setup.gravity = DVec3::Z * -9.81;
    setup.sleep = Some(Sleep::default());
    let mut blocks = blocks(setup);
    run(&mut blocks, 0.5);
    let fell_asleep = blocks.poses()[1];
    assert_eq!(fell_asleep.velocity, DVec3::ZERO);
    run(&mut blocks, 1.0);
    assert_eq!(blocks.poses()[1], fell_asleep);
    let pull: f64 = blocks.contacts().map(|contact| contact.force.z).sum();
    assert_relative(pull, WEIGHT, 1e-3);
}

/// Faces that meet only along an edge, within the rounding of scenes, have no bond.
#[test]
fn an_edge_holds_no_bond() {
    for width in [1e-8, 1e-2] {
        let mut setup = hanging(tensile(1e5), 0.0);
        setup.blocks[1].centre.x = 0.5 + 0.1 - width;
        let mut blocks = blocks(setup);
        run(&mut blocks, 1e-3);
        let bonds = blocks.contacts().filter(|contact| contact.bonded).count();
        assert_eq!(bonds, usize::from(width > 1e-3), "{width} m");
    }
}
