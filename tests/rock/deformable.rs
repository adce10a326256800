//! Deformable blocks, alone and among rigid ones.

use crate::fixture::{assert_restarts, blocks, cuboid, floor, formulas, joint, run, setup};
use glam::{DMat3, DQuat, DVec3};
use kit::{assert_contains, assert_near, assert_relative};
use riprap::{
    geometry::{Load, skew},
    rock::{
        Block, Blocks, Deformable, FixedPoint, PointLoad, Setup, Sleep,
        law::{Elastic, Joint},
    },
};

const DENSITY: f64 = 2500.0;
const G: f64 = 9.81;

fn elastic(mut setup: Setup, youngs_modulus: f64) -> Setup {
    setup.materials[0].elastic = Some(Elastic {
        youngs_modulus,
        poissons_ratio: 0.25,
    });
    setup
}

fn held(block: Block, point: DVec3) -> Block {
    let fixed_points = vec![FixedPoint {
        point,
        axes: [true; 3],
    }];
    let deformable = Deformable {
        fixed_points,
        ..Deformable::default()
    };
    Block {
        deformable: Some(deformable),
        ..block
    }
}

fn error(blocks: &Blocks, start: f64) -> f64 {
    let ledger = blocks.ledger();
    let turned = ledger.kinetic.abs() + ledger.dissipated() + ledger.strain + ledger.elastic;
    (ledger.balance() - start).abs() / turned
}

/// A point can be fixed after a restart if it has not moved.
#[test]
fn points_that_have_moved_are_not_fixed_by_a_restart() {
    let of = |points: bool| {
        let block = Block::new("bar", cuboid(1.0, 1.0, 1.0), DVec3::ZERO);
        let mut block = held(block, DVec3::splat(0.5));
        if !points {
            block.deformable = Some(Deformable::default());
        }
        blocks(elastic(setup(vec![block], joint(1e9, 30.0)), 1e9))
    };
    let mut falls = of(false);
    of(true).restore(&falls.snapshot()).expect("no motion yet");
    run(&mut falls, 0.01);
    let refused = of(true).restore(&falls.snapshot()).expect_err("it fell");
    assert_contains(refused, &["block bar: ", "have moved by 4.9"]);
    let mut hangs = of(true);
    run(&mut hangs, 0.4);
    of(true).restore(&hangs.snapshot()).expect("a pendulum");
}

/// The exact solution of the pendulum with two unknowns tends to that of the rigid pendulum as the block stiffens. The
/// fixed point does not move.
#[test]
fn a_block_swings_about_a_fixed_point() {
    let corner = DVec3::splat(0.5);
    let block = Block::new("pendulum", cuboid(1.0, 1.0, 1.0), DVec3::ZERO);
    let mut blocks = blocks(elastic(
        setup(vec![held(block, corner)], joint(1e9, 30.0)),
        1e9,
    ));
    let start = blocks.ledger().balance();
    run(&mut blocks, 0.4);
    let pose = blocks.poses()[0];
    assert!((pose.point(corner) - corner).length() < 1e-12);
    let ledger = blocks.ledger();
    // The error of the central difference, as a share of the released energy: (ωΔt)² of the oscillation of the strain.
    let fallen = blocks.mass(0) * G * -pose.centre.z;
    assert!(fallen > 1000.0, "{fallen}");
    assert_near(ledger.balance(), start, 1e-3 * fallen);
    // ½Iω² about the corner, I = (1/6 + 3/4) m a² for the axes across the diagonal.
    let spin = blocks.spins().next().expect("one").length();
    let rigid = (2.0 * fallen / (blocks.mass(0) * (1.0 / 6.0 + 0.75))).sqrt();
    assert_relative(spin, rigid, 1e-3);
}

#[test]
fn forces_at_points_stretch_a_block_and_move_it() {
    let (young, force) = (1e9, 4e5);
    let mut block = Block::new("pulled", cuboid(2.0, 1.0, 1.0), DVec3::ZERO).deformable();
    let load = |x: f64, f: String| PointLoad {
        point: DVec3::X * x,
        force: formulas([&f, "0", "0"]),
    };
    block.point_loads = vec![
        load(1.0, format!("{force}")),
        load(-1.0, format!("-{force}")),
    ];
    block.acceleration = Some(formulas(["0", "3*t", "0"]));
    let mut setup = elastic(setup(vec![block], joint(1e9, 30.0)), young);
    setup.gravity = DVec3::ZERO;
    let mut blocks = blocks(setup);
    let start = blocks.ledger().balance();
    run(&mut blocks, 0.2);
    // The stress oscillates between zero and twice the static stress, which is its mean.
    let mut sum = 0.0;
    let mut count = 0.0;
    // Period of the axial mode, √(12E/ρ)/L = 1095 rad/s.
    let period = std::f64::consts::TAU * 2.0 / (12.0 * young / DENSITY).sqrt();
    for n in 1..=400 {
        run(&mut blocks, 0.2 + 10.0 * period * f64::from(n) / 400.0);
        sum += blocks.stress(0).expect("it deforms").x_axis.x;
        count += 1.0;
    }
    let mean = sum / count;
    assert_relative(mean, force, 0.02);
    let t = blocks.time();
    let pose = blocks.poses()[0];
    // ∫3t dt, exact for the trapezoidal rule.
    assert_relative(pose.velocity.y, 1.5 * t * t, 1e-9);
    assert!(pose.velocity.x.abs() < 1e-9 && pose.centre.x.abs() < 1e-12);
    assert!(error(&blocks, start) < 0.01, "{:?}", blocks.ledger());
}

#[test]
fn a_load_squeezes_by_its_moment_and_an_initial_stress_lets_go() {
    let young = 1e9;
    let pressure = 2e6;
    let block = Block::new("cube", cuboid(1.0, 1.0, 1.0), DVec3::ZERO);
    let mut setup = elastic(
        setup(vec![block.clone().deformable()], joint(1e9, 30.0)),
        young,
    );
    (setup.gravity, setup.damping) = (DVec3::ZERO, 3000.0);
    let mut squeezed = blocks(setup.clone());
    let load = Load {
        moment: DMat3::IDENTITY * -pressure + 0.5 * skew(DVec3::ZERO),
        ..Load::default()
    };
    squeezed.set_loads(&[load]).expect("one load a block");
    run(&mut squeezed, 0.05);
    let stress = squeezed.stress(0).expect("it deforms");
    // Cauchy stress refers to the present area, smaller by 2p(1 − 2ν)/E = 2e-3.
    assert_relative(stress.x_axis.x, -pressure, 5e-3);
    let volume = squeezed.poses()[0].deformation.determinant() - 1.0;
    let bulk = young / (3.0 * (1.0 - 2.0 * 0.25));
    assert_relative(volume, -pressure / bulk, 5e-3);

    // The initial stress of a rotated block is along the axes of the world.
    let turn = DQuat::from_rotation_z(0.5);
    let r = DMat3::from_quat(turn);
    setup.blocks = vec![Block {
        deformable: Some(Deformable {
            initial_stress: DMat3::from_diagonal(DVec3::X * -pressure),
            ..Deformable::default()
        }),
        ..block.rotated(turn)
    }];
    let mut freed = blocks(setup);
    let at_start = freed.stress(0).expect("it deforms");
    let along = DMat3::from_diagonal(DVec3::X * -pressure);
    assert!(at_start.abs_diff_eq(along, 1e-6), "{at_start}");
    run(&mut freed, 0.05);
    let stress = freed.stress(0).expect("it deforms");
    assert!(stress.abs_diff_eq(DMat3::ZERO, 1e-3 * pressure), "{stress}");
    // It expands by the strain that the stress had caused, along x of the world.
    let strain = r * freed.strain(0).expect("it deforms") * r.transpose();
    assert_relative(strain.x_axis.x, pressure / young, 5e-3);
}

/// A cube under a pressure that begins suddenly. Its uniform strain, the stiffest mode, vibrates with ω = √(12 · 3K/ρ)/a and reaches
/// twice the static pressure. With loads that are constant over 2/ω or more it has critical damping; over 0.2/ω a hundredth of it.
/// A rotation is not damped.
#[test]
fn strains_that_the_interval_of_the_loads_does_not_resolve_are_damped() {
    let (young, pressure) = (1e9, 2e6);
    let block = Block {
        spin: DVec3::Z,
        ..Block::new("cube", cuboid(1.0, 1.0, 1.0), DVec3::ZERO).deformable()
    };
    let mut setup = elastic(setup(vec![block], joint(1e9, 30.0)), young);
    setup.gravity = DVec3::ZERO;
    let bulk = young / (3.0 * (1.0 - 2.0 * 0.25));
    let omega = (12.0 * 3.0 * bulk / DENSITY).sqrt();
    // ∫ over half a period of e^{−ζωt} in the peak: 1 + e^{−πζ/√(1−ζ²)}.
    let light = 1.0 + (-std::f64::consts::PI * 0.01).exp();
    for (interval, most) in [
        (0.0, 2.0),
        (0.2 / omega, light),
        (2.0 / omega, 1.0),
        (1.0, 1.0),
    ] {
        let mut cube = blocks(setup.clone());
        cube.set_load_interval(interval);
        let load = Load {
            moment: DMat3::IDENTITY * -pressure,
            ..Load::default()
        };
        cube.set_loads(&[load]).expect("one load a block");
        let start = cube.ledger();
        let mut peak: f64 = 0.0;
        for n in 1..=200 {
            run(&mut cube, 10.0 / omega * f64::from(n) / 200.0);
            let stress = cube.stress(0).expect("it deforms");
            peak = peak.max(-stress.z_axis.z / pressure);
        }
        println!("{interval:.1e}: {peak}, {most}");
        assert_near(peak, most, 0.02);
        assert!(error(&cube, start.balance()) < 5e-3, "{:?}", cube.ledger());
        let lost = cube.ledger().mass_damping;
        assert_eq!(lost > 0.0, interval > 0.0);
        let spin = cube.spins().next().expect("one").length();
        assert_relative(spin, 1.0, 1e-2);
    }
}

/// A wall of two irregular courses, every second block rigid.
fn wall() -> Setup {
    let mut list = vec![floor()];
    for i in 0..24u32 {
        let [x, y, z] = [i % 4, i / 4 % 3, i / 12].map(f64::from);
        let turn = DQuat::from_rotation_z(0.1 * (3.0 * x + 2.0 * y + z).sin());
        let at = DVec3::new(0.85 * x + 0.4 * z - 1.5, 0.8 * y - 0.8, 0.249 + 0.499 * z);
        let block = Block::new(format!("{i}"), cuboid(0.7, 0.6, 0.5), at).rotated(turn);
        list.push(if i % 2 == 0 {
            block.deformable()
        } else {
            block
        });
    }
    elastic(setup(list, joint(1e7, 30.0)), 1e8)
}

/// Two bonded slabs, one of which starts with a spin. The springs of the bond follow the normals of its faces, which also turn as a
/// slab shears, and do as much work as they store.
#[test]
fn bonded_slabs_keep_their_energy() {
    let slab =
        |x: f64| Block::new(format!("{x}"), cuboid(0.3, 1.0, 1.0), DVec3::X * x).deformable();
    let turning = Block {
        spin: DVec3::Y * 1e-3,
        ..slab(0.0)
    };
    let bond = Joint {
        tensile_strength: 1e9,
        cohesion: 1e9,
        damping: 0.0,
        ..joint(4e10, 35.0)
    };
    let mut setup = elastic(setup(vec![turning, slab(0.3)], bond), 1e10);
    setup.gravity = DVec3::ZERO;
    let mut blocks = blocks(setup);
    let energy = |blocks: &Blocks| {
        let ledger = blocks.ledger();
        ledger.kinetic + ledger.strain + ledger.elastic
    };
    let start = energy(&blocks);
    for n in 1..=30 {
        run(&mut blocks, 0.01 * f64::from(n));
        assert_relative(energy(&blocks), start, 1e-2);
    }
}

#[test]
fn the_bits_depend_neither_on_threads_nor_on_where_a_run_was_cut() {
    let state = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads").install(|| {
            let mut blocks = blocks(wall());
            run(&mut blocks, 0.02);
            assert!(blocks.contacts().count() > 20);
            blocks.snapshot()
        })
    };
    let one = state(1);
    assert_eq!(one, state(3));

    let whole = assert_restarts(&wall(), 0.02, 0.04);
    let mut resumed = blocks(wall());
    resumed.restore(&whole.snapshot()).expect("the same blocks");
    let stresses = |blocks: &Blocks| (0..25).map(|i| blocks.stress(i)).collect::<Vec<_>>();
    assert_eq!(stresses(&resumed), stresses(&whole));

    // The same blocks, all rigid, are another scene.
    let mut rigid = wall();
    for block in &mut rigid.blocks {
        block.deformable = None;
    }
    assert!(blocks(rigid).restore(&one).is_err());
}

#[test]
fn a_block_that_deforms_never_sleeps_and_its_rigid_neighbour_does() {
    let list = vec![
        floor(),
        Block::new("rigid", cuboid(1.0, 1.0, 1.0), DVec3::new(-2.0, 0.0, 0.5)),
        Block::new("soft", cuboid(1.0, 1.0, 1.0), DVec3::new(2.0, 0.0, 0.5)).deformable(),
    ];
    let mut setup = elastic(setup(list, joint(1e9, 30.0)), 1e9);
    setup.damping = 500.0;
    setup.sleep = Some(Sleep {
        speed: 1e-4,
        after: 0.01,
        ..Sleep::default()
    });
    let mut blocks = blocks(setup);
    run(&mut blocks, 0.1);
    let asleep: Vec<bool> = blocks.asleep().collect();
    assert_eq!(asleep, [false, true, false]);
    let weight = blocks.mass(2) * G;
    let bears = blocks.stress(2).expect("it deforms").z_axis.z;
    assert_relative(bears, -0.5 * weight, 1e-3);
}
