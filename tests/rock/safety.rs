//! Factors of safety of blocks that stand on others, from their contacts.

use crate::fixture::{blocks, cuboid, formulas, joint, run, setup, slope};
use glam::DVec3;
use kit::{assert_near, assert_relative};
use riprap::{
    geometry::{HalfSpace, Polyhedron},
    rock::{Block, PairMaterial, Period, PointLoad, Setup, law::Joint},
    safety::{Mode, SafetyFactors},
};
use std::sync::Arc;

/// A block with a square base of side b and the height h, on an incline of `alpha` degrees.
fn on_incline(alpha: f64, [b, h]: [f64; 2], joint: Joint) -> Setup {
    let turn = slope(alpha);
    let plate = Block::new("plate", cuboid(12.0, 3.0, 1.0), turn * DVec3::Z * -0.5);
    let block = Block::new("block", cuboid(b, b, h), turn * DVec3::Z * (0.5 * h));
    setup(
        vec![plate.fixed().rotated(turn), block.rotated(turn)],
        joint,
    )
}

/// A prism on two slabs that meet in a line: each plane has dip, dip direction and friction angle, degrees.
fn wedge(planes: [[f64; 3]; 2]) -> Setup {
    // Upward normals; x east, y north.
    let normals = planes.map(|[dip, direction, _]| {
        let (dip, direction) = (dip.to_radians(), direction.to_radians());
        DVec3::new(
            dip.sin() * direction.sin(),
            dip.sin() * direction.cos(),
            dip.cos(),
        )
    });
    let face = |normal: DVec3, distance: f64| HalfSpace { normal, distance };
    let block = |name: &str, faces: &[HalfSpace]| {
        let (shape, at) = Polyhedron::from_half_spaces(faces).expect("a block");
        Block::new(name, Arc::new(shape.into()), at)
    };
    let line = normals[0].cross(normals[1]).normalize();
    let mut list = vec![block(
        "wedge",
        &[
            face(-normals[0], 0.0),
            face(-normals[1], 0.0),
            face((normals[0] + normals[1]).normalize(), 1.0),
            face(line, 1.0),
            face(-line, 1.0),
        ],
    )];
    for (k, n) in normals.into_iter().enumerate() {
        let across = line.cross(n);
        let sides = [line, -line, across, -across].map(|side| face(side, 6.0));
        let mut slab = block(
            "slab",
            &[&sides[..], &[face(n, 0.0), face(-n, 1.0)]].concat(),
        );
        slab.material = k + 1;
        list.push(slab.fixed());
    }
    let joints = planes.map(|plane| joint(1e9, plane[2]));
    let mut setup = setup(list, joints[0]);
    setup.materials = vec![setup.materials[0]; 3];
    let pair = |k: usize| PairMaterial {
        materials: [0, k + 1],
        joint: joints[k],
    };
    setup.pairs = vec![pair(0), pair(1)];
    setup
}

/// Factors of safety of the block `block` with a fluid force (N), after it has come to rest under mass damping.
fn standing(setup: Setup, block: usize, force: DVec3) -> SafetyFactors {
    let mut blocks = blocks(Setup {
        damping: 50.0,
        ..setup.clone()
    });
    run(&mut blocks, 0.3);
    SafetyFactors::of(&setup, &blocks, block, [force, DVec3::ZERO])
}

/// tan φ/tan α and (b/h)/tan α; the contact's normal and area include the tilt from its compliance, 1e-4.
#[test]
fn a_block_on_an_incline() {
    let lying = || on_incline(30.0, [1.0, 0.4], joint(1e8, 60.0));
    let (tan_alpha, tan_phi) = (30f64.to_radians().tan(), 60f64.to_radians().tan());
    let still = standing(lying(), 1, DVec3::ZERO);
    assert_eq!(still.sliding.mode, Mode::OnOne(0));
    assert_relative(still.sliding.factor, tan_phi / tan_alpha, 1e-3);
    assert_near(still.toppling * 0.4 * tan_alpha, 1.0, 1e-3);
    assert_eq!(still.uplift, f64::INFINITY);
    // Under water the factor of sliding is the same, that of uplift is the ratio of the densities, and buoyancy, W/2.5, has
    // the overturning moment of the resisting less the driving part of the weight.
    let buoyancy = DVec3::Z * 1000.0 * 9.81 * 0.4;
    let wet = standing(lying(), 1, buoyancy);
    assert_relative(wet.sliding.factor, still.sliding.factor, 1e-9);
    let driven = 1.0 / still.toppling;
    let exact = 1.0 / (driven + (1.0 - driven) / 2.5);
    assert_relative(wet.toppling, exact, 1e-9);
    assert_near(wet.uplift, 2.5, 1e-9);
}

/// A strip at the upper edge of the base has lifted off; the column topples over the other edge.
#[test]
fn a_column_topples_over_its_edge() {
    let found = standing(
        on_incline(20.0, [1.0, 2.0], joint(4e10, 50.0)),
        1,
        DVec3::ZERO,
    )
    .toppling;
    let exact = 0.5 / 20f64.to_radians().tan();
    assert_relative(found, exact, 1e-3);
}

/// At the initial position, before any step, from the faces that lie on others.
#[test]
fn before_it_presses_it_stands_on_its_faces() {
    for alpha in [10f64, 20.0] {
        let setup = on_incline(alpha, [1.0, 2.0], joint(4e10, 50.0));
        let found = SafetyFactors::of(&setup, &blocks(setup.clone()), 1, [DVec3::ZERO; 2]);
        let tan_alpha = alpha.to_radians().tan();
        let tan_phi = 50f64.to_radians().tan();
        assert_relative(found.sliding.factor * tan_alpha, tan_phi, 1e-9);
        assert_relative(found.toppling * tan_alpha, 0.5, 1e-3);
    }
}

#[test]
fn a_wedge_on_two_planes() {
    // The factor of safety of Goodman & Shi 1985.
    let planes = [[45.0, 105.0, 20.0], [70.0, 235.0, 30.0]];
    let found = standing(wedge(planes), 0, DVec3::ZERO).sliding;
    assert!(matches!(found.mode, Mode::OnTwo(..)), "{found:?}");
    assert_relative(found.factor, 1.10662, 1e-3);
}

/// A block b wide and h high of weight W on the level: a force P at the height z gives W tan φ/P and W b/(2 P z), an
/// acceleration a gives g tan φ/a and g b/(a h). Without them there is no driving force, despite rounding in the contacts.
#[test]
fn point_loads_and_accelerations_drive() {
    let standing = |change: &dyn Fn(&mut Block)| {
        let floor = Block::new("floor", cuboid(4.0, 4.0, 1.0), DVec3::Z * -0.5).fixed();
        let mut block = Block::new("block", cuboid(0.2, 0.3, 0.5), DVec3::Z * 0.25);
        change(&mut block);
        let setup = setup(vec![floor, block], joint(1e9, 45.0));
        let found = standing(setup, 1, DVec3::ZERO);
        [found.sliding.factor, found.toppling, found.uplift]
    };
    let weight = 0.03 * 2500.0 * 9.81;
    let pushed = standing(&|block| {
        block.point_loads = vec![PointLoad {
            point: DVec3::new(0.1, 0.0, 0.2),
            force: formulas(["100*min(1,t/0.3)", "0", "0"]),
        }];
    });
    let accelerated = standing(&|block| {
        block.acceleration = Some(formulas(["2*min(1,t/0.3)", "0", "0"]));
    });
    let lifted = standing(&|block| {
        block.acceleration = Some(formulas(["0", "0", "4.905"]));
    });
    for (found, exact) in [
        (pushed[0], weight / 100.0),
        (pushed[1], weight * 0.1 / (100.0 * 0.45)),
        (accelerated[0], 9.81 / 2.0),
        (accelerated[1], 9.81 * 0.2 / (2.0 * 0.5)),
        (lifted[2], 2.0),
    ] {
        assert_relative(found, exact, 1e-3);
    }
    assert_eq!([pushed[2], accelerated[2]], [f64::INFINITY; 2]);
    assert_eq!(standing(&|_| {}), [f64::INFINITY; 3]);
}

/// A fixed block has no contacts with a fixed floor. It still stands on the floor, also with another block on top.
#[test]
fn a_held_block_stands_on_what_is_held_too() {
    let floor = Block::new("floor", cuboid(4.0, 4.0, 1.0), DVec3::Z * -0.5).fixed();
    let held = Block::new("held", cuboid(0.4, 0.4, 0.4), DVec3::Z * 0.2).fixed();
    let above = Block::new("above", cuboid(0.2, 0.2, 0.2), DVec3::Z * 0.5);
    let setup = setup(vec![floor, held, above], joint(1e9, 45.0));
    let mut blocks = blocks(setup.clone());
    run(&mut blocks, 0.1);
    assert!(blocks.contacts().any(|contact| contact.blocks == [1, 2]));
    let weight = 0.064 * 2500.0 * 9.81;
    let push = DVec3::X * 0.5 * weight;
    let found = SafetyFactors::of(&setup, &blocks, 1, [push, DVec3::ZERO]);
    assert_relative(found.sliding.factor, 2.0, 1e-6);
}

/// The pillar reaches 0.2 m beyond the periodic border, and the block stands on the image of that part with its right end.
#[test]
fn a_block_stands_on_the_image_of_another() {
    let pillar = Block::new("pillar", cuboid(0.4, 1.0, 1.0), DVec3::Z * -0.5).fixed();
    let block = Block::new("block", cuboid(1.0, 0.4, 0.5), DVec3::new(1.5, 0.0, 0.25));
    let joint = Joint {
        cohesion: 1e4,
        ..joint(1e9, 45.0)
    };
    let mut setup = setup(vec![pillar, block], joint);
    setup.period = Some(Period {
        origin: DVec3::ZERO,
        size: DVec3::new(2.0, f64::INFINITY, f64::INFINITY),
    });
    let weight = 0.2 * 2500.0 * 9.81;
    let push = DVec3::Y * weight;
    let found = SafetyFactors::of(&setup, &blocks(setup.clone()), 1, [push, DVec3::ZERO]);
    // The block reaches from 1 to 2 m, the image of the pillar from 1.8 m on.
    let exact = (1e4 * 0.2 * 0.4 + weight) / weight;
    // Faces in contact may be apart by a ten-thousandth of the radius.
    assert_relative(found.sliding.factor, exact, 1e-3);
}

/// A block on the edges of two pillars: its springs use the area of corners, cohesion uses the true area.
#[test]
fn cohesion_counts_with_the_section_and_not_with_the_area_of_corners() {
    let pillar = |x: f64| {
        let at = DVec3::new(x, 0.0, -0.05);
        Block::new(format!("pillar at {x}"), cuboid(0.1, 0.1, 0.1), at).fixed()
    };
    let block = Block::new("block", cuboid(0.2, 0.2, 0.2), DVec3::Z * 0.1);
    let joint = Joint {
        cohesion: 1e4,
        ..joint(1e9, 45.0)
    };
    let mut setup = setup(vec![pillar(-0.1), pillar(0.1), block], joint);
    setup.corner_area = 1.0;
    let weight = 0.008 * 2500.0 * 9.81;
    let push = DVec3::Y * weight;
    let found = standing(setup, 2, push).sliding;
    let exact = (1e4 * 0.01 + weight) / weight;
    assert_relative(found.factor, exact, 1e-3);
}

/// A block on many small pieces has the factors of one on a slab, also before it has contacts.
#[test]
fn a_floor_of_small_pieces_counts_as_a_whole() {
    let block = || Block::new("block", cuboid(1.0, 1.0, 1.0), DVec3::Z * 0.5);
    let side = 0.025;
    let piece = |k: usize| {
        let [x, y] = [k / 44, k % 44].map(|i| (i as f64 - 21.5) * side);
        let at = DVec3::new(x, y, -0.5);
        Block::new("floor", cuboid(side, side, 1.0), at).fixed()
    };
    let load = [DVec3::X * 1e3, DVec3::ZERO];
    let factors = |floor: Vec<Block>| {
        let list = [block()].into_iter().chain(floor).collect();
        let setup = setup(list, joint(1e9, 30.0));
        SafetyFactors::of(&setup, &blocks(setup.clone()), 0, load)
    };
    let slab = Block::new("floor", cuboid(1.1, 1.1, 1.0), DVec3::Z * -0.5);
    let (whole, pieces) = (
        factors(vec![slab.fixed()]),
        factors((0..44 * 44).map(piece).collect()),
    );
    assert_relative(pieces.sliding.factor, whole.sliding.factor, 1e-6);
    assert_relative(pieces.toppling, whole.toppling, 1e-3);
}
