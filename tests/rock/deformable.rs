//! Blocks that deform, among themselves and among rigid ones.

use crate::fixture::{blocks, cuboid, joint, run, setup};
use glam::{DMat3, DQuat, DVec3};
use riprap::{
    geometry::{Load, skew},
    rock::{
        Block, Blocks, Deformable, FixedPoint, PointLoad, Setup, Sleep, Snapshot, law::Elastic,
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

fn floor() -> Block {
    Block::new("floor", cuboid(9.0, 9.0, 1.0), DVec3::Z * -0.5).fixed()
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
    let turned = ledger.kinetic.abs() + ledger.taken() + ledger.strain + ledger.elastic;
    (ledger.balance() - start).abs() / turned
}

/// A bar that hangs by the middle of its upper face: the affine theory has P = mg ⊗ X/V, X half its length,
/// which is the mean stress ρgL/2 of the exact solution, and its elongation ρgL²/2E.
#[test]
fn a_bar_hangs_under_its_weight_as_affine_theory_has_it() {
    let (length, young) = (10.0, 5e9);
    // Its length lies along x of its own frame.
    let turn = DQuat::from_rotation_y(0.5 * std::f64::consts::PI) * DQuat::from_rotation_x(0.4);
    let bar = Block::new("bar", cuboid(length, 1.0, 0.8), DVec3::ZERO).turned(turn);
    let top = DVec3::X * (-0.5 * length);
    let mut setup = elastic(setup(vec![held(bar, top)], joint(1e9, 30.0)), young);
    // Twice the frequency of its axial mode takes its swinging fastest. Held at one end, its inertia is that
    // about the end, four times that about the middle: ω = ½√(12E/ρ)/L = 245 rad/s.
    setup.damping = (12.0 * young / DENSITY).sqrt() / length;
    let mut blocks = blocks(setup);
    let start = blocks.ledger().balance();
    let before = blocks.poses()[0].point(top);
    run(&mut blocks, 0.1);
    let pose = blocks.poses()[0];
    // Nothing but rounding moves it: 12 000 additions of it.
    assert!(
        (pose.point(top) - before).length() < 1e-12,
        "{}",
        pose.point(top) - before
    );
    let stress = blocks.stress(0).expect("it deforms");
    let mean = 0.5 * DENSITY * G * length;
    assert!((stress.z_axis.z / mean - 1.0).abs() < 1e-4, "{stress}");
    let other = (stress - DMat3::from_diagonal(DVec3::Z * stress.z_axis.z)).to_cols_array();
    assert!(other.iter().all(|s| s.abs() < 1e-5 * mean), "{stress}");
    assert!((blocks.von_mises(0).expect("it deforms") / mean - 1.0).abs() < 1e-4);
    let end = (pose.point(-top) - pose.point(top)).length();
    let elongation = mean * length / young;
    assert!(
        ((end - length) / elongation - 1.0).abs() < 1e-4,
        "{}",
        end - length
    );
    let thinner = (pose.deformation * DVec3::Y).length() - 1.0;
    assert!(
        (thinner / (-0.25 * mean / young) - 1.0).abs() < 1e-3,
        "{thinner}"
    );
    let weight = blocks.mass(0) * G;
    let support = blocks.support(0).expect("it is held");
    assert!(
        (support - DVec3::Z * weight).length() < 1e-5 * weight,
        "{support}"
    );
    assert!(error(&blocks, start) < 0.01, "{:?}", blocks.ledger());
    let energy = 0.5 * mean * mean / young * 8.0;
    assert!(
        (blocks.ledger().strain / energy - 1.0).abs() < 1e-3,
        "{:?}",
        blocks.ledger()
    );
}

/// The exact solution of the pendulum of two unknowns is that of the rigid one as the block stiffens, and its
/// fixed point stays.
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
    // Of the energy that fell, what the central difference has wrong: (ωΔt)² of the swinging of the strain.
    let fallen = blocks.mass(0) * G * -pose.centre.z;
    assert!(fallen > 1000.0, "{fallen}");
    assert!(
        (ledger.balance() - start).abs() < 1e-3 * fallen,
        "{ledger:?}"
    );
    // ½Iω² about the corner, I = (1/6 + 3/4) m a² for the axes across the diagonal.
    let spin = blocks.spins().next().expect("one").length();
    let rigid = (2.0 * fallen / (blocks.mass(0) * (1.0 / 6.0 + 0.75))).sqrt();
    assert!((spin / rigid - 1.0).abs() < 1e-3, "{spin}, {rigid}");
}

/// Blocks on each other, the lower one rigid or not: what each bears is what stands on it and half of itself.
#[test]
fn a_stack_of_two_bears_its_weight_whatever_its_lower_block() {
    for lower_deforms in [true, false] {
        let cube = |name: &str, z: f64| Block::new(name, cuboid(1.0, 1.0, 1.0), DVec3::Z * z);
        let lower = cube("lower", 0.5);
        let lower = if lower_deforms {
            lower.deformable()
        } else {
            lower
        };
        let list = vec![floor(), lower, cube("upper", 1.5).deformable()];
        let mut setup = elastic(setup(list, joint(1e9, 30.0)), 1e9);
        // Of the slowest mode, two blocks on their contacts and their own elasticity: about 260 rad/s.
        setup.damping = 500.0;
        let mut blocks = blocks(setup);
        let start = blocks.ledger().balance();
        run(&mut blocks, 0.15);
        let weight = blocks.mass(2) * G;
        let bears = |block: usize| blocks.stress(block).map(|stress| stress.z_axis.z);
        let upper = bears(2).expect("it deforms");
        assert!((upper / (-0.5 * weight) - 1.0).abs() < 1e-3, "{upper}");
        match bears(1) {
            Some(lower) => assert!((lower / (-1.5 * weight) - 1.0).abs() < 1e-3, "{lower}"),
            None => assert!(!lower_deforms),
        }
        // Nothing holds them sideways but what friction does: they widen by ν σ/E.
        assert!(error(&blocks, start) < 0.01, "{:?}", blocks.ledger());
    }
}

/// Two bars that meet end to end leave each other with the momentum that they had, and the energy is theirs.
#[test]
fn two_blocks_that_collide_keep_momentum_and_energy() {
    let bar = |name: &str, x: f64, v: f64| Block {
        velocity: DVec3::X * v,
        ..Block::new(name, cuboid(2.0, 0.5, 0.5), DVec3::new(x, 0.0, 0.0)).deformable()
    };
    let list = vec![bar("left", -1.01, 1.0), bar("right", 1.01, 0.0)];
    let mut joint = joint(1e11, 30.0);
    joint.damping = 0.0;
    let mut setup = elastic(setup(list, joint), 1e10);
    setup.gravity = DVec3::ZERO;
    let mut blocks = blocks(setup);
    let before = blocks.ledger();
    run(&mut blocks, 0.04);
    let after = blocks.ledger();
    let momentum: DVec3 = blocks.poses().iter().map(|p| p.velocity).sum();
    assert!((momentum - DVec3::X).length() < 1e-12, "{momentum}");
    assert!(
        blocks.poses()[1].velocity.x > 0.5,
        "{:?}",
        blocks.poses()[1].velocity
    );
    assert_eq!(blocks.contacts().count(), 0);
    let error = (after.balance() - before.balance()).abs() / before.kinetic;
    assert!(error < 0.01, "{error}: {after:?}");
    // They ring: some of it is strain, or was a moment ago.
    assert!(after.strain > 1e-4 * before.kinetic, "{after:?}");
}

/// Where a block is that was thrown onto the floor, slid and turned.
fn thrown(young: Option<f64>) -> (DVec3, DQuat) {
    let turn = DQuat::from_scaled_axis(DVec3::new(0.3, 0.2, 0.1));
    let mut block = Block::new("thrown", cuboid(1.0, 0.8, 0.6), DVec3::Z * 0.55).turned(turn);
    (block.velocity, block.spin) = (DVec3::new(1.0, 0.3, -1.0), DVec3::new(0.5, -1.0, 2.0));
    block.deformable = young.map(|_| Deformable::default());
    let mut setup = setup(vec![floor(), block], joint(1e8, 30.0));
    // A corner that is as stiff as a part of a face: what happens there then changes little with the step.
    setup.corner_area = 0.25;
    setup.largest_overlap = 0.3;
    // What the stiffest needs, so that the step is no part of the difference.
    setup.time_step = Some(1e-5);
    let mut blocks = blocks(elastic(setup, young.unwrap_or(1e9)));
    run(&mut blocks, 0.2);
    assert!(blocks.contacts().count() > 0 || blocks.ledger().friction > 0.0);
    (blocks.poses()[1].centre, blocks.rotation(1))
}

#[test]
fn a_stiff_block_moves_as_a_rigid_one() {
    let (centre, rotation) = thrown(None);
    let off = |young: f64| {
        let (at, turned) = thrown(Some(young));
        (at - centre).length() + turned.angle_between(rotation)
    };
    let [soft, stiff] = [1e9, 1e10].map(off);
    println!("off by {soft:.2e} and {stiff:.2e}");
    // A tenth by theory; contacts that begin a step earlier or later leave their share.
    assert!(soft > 1e-5 && stiff < 0.2 * soft, "{stiff} of {soft}");
}

#[test]
fn forces_at_points_stretch_a_block_and_move_it() {
    let (young, force) = (1e9, 4e5);
    let mut block = Block::new("pulled", cuboid(2.0, 1.0, 1.0), DVec3::ZERO).deformable();
    let load = |x: f64, f: String| PointLoad {
        point: DVec3::X * x,
        force: [&f, "0", "0"].map(|f| f.parse().expect("a formula")),
    };
    block.point_loads = vec![
        load(1.0, format!("{force}")),
        load(-1.0, format!("-{force}")),
    ];
    block.acceleration = Some(["0", "3*t", "0"].map(|f| f.parse().expect("a formula")));
    let mut setup = elastic(setup(vec![block], joint(1e9, 30.0)), young);
    setup.gravity = DVec3::ZERO;
    let mut blocks = blocks(setup);
    let start = blocks.ledger().balance();
    run(&mut blocks, 0.2);
    // It swings about the static stress, from zero to twice of it; the mean is it.
    let mut sum = 0.0;
    let mut count = 0.0;
    // Periods of the axial mode, √(12E/ρ)/L = 1095 rad/s.
    let period = std::f64::consts::TAU * 2.0 / (12.0 * young / DENSITY).sqrt();
    for n in 1..=400 {
        run(&mut blocks, 0.2 + 10.0 * period * f64::from(n) / 400.0);
        sum += blocks.stress(0).expect("it deforms").x_axis.x;
        count += 1.0;
    }
    let mean = sum / count;
    assert!((mean / force - 1.0).abs() < 0.02, "{mean}");
    let t = blocks.time();
    let pose = blocks.poses()[0];
    // ∫3t dt, exact for the trapezoidal rule.
    assert!(
        (pose.velocity.y / (1.5 * t * t) - 1.0).abs() < 1e-9,
        "{}",
        pose.velocity
    );
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
    squeezed.load(&[load]).expect("one load a block");
    run(&mut squeezed, 0.05);
    let stress = squeezed.stress(0).expect("it deforms");
    // Cauchy stress counts the present area, smaller by 2p(1 − 2ν)/E = 2e-3.
    assert!((stress.x_axis.x / -pressure - 1.0).abs() < 5e-3, "{stress}");
    let volume = squeezed.poses()[0].deformation.determinant() - 1.0;
    let bulk = young / (3.0 * (1.0 - 2.0 * 0.25));
    assert!((volume / (-pressure / bulk) - 1.0).abs() < 5e-3, "{volume}");

    // The stress of a turned block stays along the axes of the world.
    let turn = DQuat::from_rotation_z(0.5);
    setup.blocks = vec![Block {
        deformable: Some(Deformable {
            initial_stress: DMat3::from_diagonal(DVec3::X * -pressure),
            ..Deformable::default()
        }),
        ..block.turned(turn)
    }];
    let mut freed = blocks(setup);
    let at_start = freed.stress(0).expect("it deforms");
    let along = DMat3::from_diagonal(DVec3::X * -pressure);
    assert!(at_start.abs_diff_eq(along, 1e-6), "{at_start}");
    run(&mut freed, 0.05);
    let stress = freed.stress(0).expect("it deforms");
    assert!(stress.abs_diff_eq(DMat3::ZERO, 1e-3 * pressure), "{stress}");
    // It widens by what the stress had pressed, along x of the world.
    let strain = turn_of(turn) * freed.strain(0).expect("it deforms") * turn_of(turn).transpose();
    assert!(
        (strain.x_axis.x / (pressure / young) - 1.0).abs() < 5e-3,
        "{strain}"
    );
}

fn turn_of(turn: DQuat) -> DMat3 {
    DMat3::from_quat(turn)
}

/// A wall of two courses, every second block rigid, laid crookedly.
fn wall() -> Setup {
    let mut list = vec![floor()];
    for i in 0..24u32 {
        let [x, y, z] = [i % 4, i / 4 % 3, i / 12].map(f64::from);
        let turn = DQuat::from_rotation_z(0.1 * (3.0 * x + 2.0 * y + z).sin());
        let at = DVec3::new(0.85 * x + 0.4 * z - 1.5, 0.8 * y - 0.8, 0.249 + 0.499 * z);
        let block = Block::new(format!("{i}"), cuboid(0.7, 0.6, 0.5), at).turned(turn);
        list.push(if i % 2 == 0 {
            block.deformable()
        } else {
            block
        });
    }
    elastic(setup(list, joint(1e7, 30.0)), 1e8)
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

    let mut whole = blocks(wall());
    run(&mut whole, 0.02);
    assert_eq!(whole.snapshot(), one);
    let bytes = postcard::to_allocvec(&one).unwrap();
    run(&mut whole, 0.04);
    let mut resumed = blocks(wall());
    let snapshot = postcard::from_bytes::<Snapshot>(&bytes).expect("a snapshot");
    resumed.restore(&snapshot).expect("the same blocks");
    run(&mut resumed, 0.04);
    assert_eq!(resumed.snapshot(), whole.snapshot());
    assert_eq!(resumed.ledger(), whole.ledger());
    let stresses = |blocks: &Blocks| (0..25).map(|i| blocks.stress(i)).collect::<Vec<_>>();
    assert_eq!(stresses(&resumed), stresses(&whole));

    // The same blocks, all rigid, are another scene.
    let mut rigid = wall();
    for block in &mut rigid.blocks {
        block.deformable = None;
    }
    assert!(blocks(rigid).restore(&snapshot).is_err());
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
    assert!((bears / (-0.5 * weight) - 1.0).abs() < 1e-3, "{bears}");
}
