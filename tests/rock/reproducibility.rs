//! The same bits for any number of threads and any restart, and no unnecessary work.

use crate::fixture::{assert_restarts, blocks, cuboid, joint, run, setup};
use glam::{DMat3, DQuat, DVec3};
use kit::assert_contains;
use riprap::{
    geometry::{Form, Part, Polyhedron, Shape},
    rock::{Block, Blocks, Setup, Snapshot},
    scene::{Scene, build::block_setup},
    simulation::{Simulation, checkpoint::Checkpoint},
};
use std::path::Path;

/// A wall of five irregular courses of sixteen blocks: more contacts than one task handles.
fn wall() -> Setup {
    let mut list = vec![Block::new("floor", cuboid(20.0, 20.0, 1.0), DVec3::Z * -0.5).fixed()];
    for i in 0..80u32 {
        let [x, y, z] = [i % 4, i / 4 % 4, i / 16].map(f64::from);
        let turn = DQuat::from_rotation_z(0.1 * (3.0 * x + 2.0 * y + z).sin());
        let at = DVec3::new(0.85 * x + 0.4 * (z % 2.0), 0.8 * y, 0.249 + 0.499 * z);
        list.push(Block::new(format!("{i}"), cuboid(0.7, 0.6, 0.5), at).rotated(turn));
    }
    setup(list, joint(1e7, 30.0))
}

#[test]
fn the_bits_do_not_depend_on_the_number_of_threads() {
    let state = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads").install(|| {
            let mut blocks = blocks(wall());
            run(&mut blocks, 0.1);
            assert!(blocks.contacts().count() > 100);
            blocks.snapshot()
        })
    };
    let one = state(1);
    assert_eq!(one, state(2));
    assert_eq!(one, state(3));
}

#[test]
fn a_snapshot_goes_on_with_the_same_bits() {
    let whole = assert_restarts(&wall(), 0.06, 0.12);
    let snapshot = whole.snapshot();
    let bytes = postcard::to_allocvec(&snapshot).expect("a snapshot");
    assert!(postcard::from_bytes::<Snapshot>(&bytes[..bytes.len() - 1]).is_err());
    let mut other = blocks(Setup {
        blocks: wall().blocks[..7].to_vec(),
        ..wall()
    });
    assert!(other.restore(&snapshot).is_err());
}

#[test]
fn a_block_that_a_restart_fixes_stops() {
    let of = |is_fixed: bool| {
        let mut block = Block::new("stone", cuboid(1.0, 1.0, 1.0), DVec3::ZERO);
        (block.velocity, block.spin) = (DVec3::X, DVec3::Y);
        if is_fixed {
            block = block.fixed();
        }
        blocks(setup(vec![block], joint(1e7, 30.0)))
    };
    let mut moved = of(false);
    run(&mut moved, 0.1);
    let before = moved.poses()[0];
    let mut fixed = of(true);
    fixed.restore(&moved.snapshot()).expect("the same block");
    assert_eq!(fixed.ledger().kinetic, 0.0);
    run(&mut fixed, 0.2);
    let after = fixed.poses()[0];
    assert_eq!(after.velocity, DVec3::ZERO);
    assert_eq!(after.deformation_rate, DMat3::ZERO);
    assert_eq!(after.centre, before.centre);
}

/// A block that slides on the first of `fixed` fixed blocks side by side.
fn slider(fixed: u32) -> Blocks {
    let mut list: Vec<_> = (0..fixed)
        .map(|i| {
            let at = DVec3::new(4.0 * f64::from(i), 0.0, -0.5);
            Block::new(format!("fixed {i}"), cuboid(4.0, 4.0, 1.0), at).fixed()
        })
        .collect();
    let mut block = Block::new("moving", cuboid(1.0, 1.0, 1.0), DVec3::Z * 0.5);
    block.velocity = DVec3::Y;
    list.push(block);
    let mut blocks = blocks(setup(list, joint(1e7, 30.0)));
    run(&mut blocks, 0.1);
    blocks
}

#[test]
fn five_fixed_blocks_and_a_moving_one_cost_what_one_costs() {
    let (one, five) = (slider(1), slider(5));
    assert!(one.counts().pairs > 100);
    assert_eq!(one.counts(), five.counts());
    assert_eq!(five.candidate_pair_count(), 1);
}

/// The same number of blocks and parts, but the other block is the compound: the contacts refer to other parts.
#[test]
fn a_snapshot_of_other_compounds_is_refused() {
    let part = |x: f64| Part {
        form: Form::Convex(Polyhedron::cuboid(DVec3::ONE).expect("a cube")),
        offset: DVec3::X * x,
    };
    let of = |double: usize| {
        let block = |n: usize| {
            let at = DVec3::Z * (0.9999 * n as f64);
            if n == double {
                let parts = vec![part(-0.5), part(0.5)];
                let (shape, _) = Shape::compound(parts).expect("two cubes");
                Block::new("double", shape, at)
            } else {
                Block::new("single", cuboid(1.0, 1.0, 1.0), at)
            }
        };
        blocks(setup(vec![block(0).fixed(), block(1)], joint(1e7, 30.0)))
    };
    let mut upper = of(1);
    run(&mut upper, 1e-3);
    assert!(upper.contacts().count() > 0);
    let message = of(0).restore(&upper.snapshot()).expect_err("other parts");
    assert!(message.to_string().contains("another scene"), "{message}");
    of(1).restore(&upper.snapshot()).expect("the same parts");
}

const SCENE: &str = r#"
    run = { duration = 1 }
    materials = [{ name = "rock", density = 2650, normal_stiffness = 1e8, friction = 35, damping = 0.2 }]
    [[blocks]]
    kind = "box"
    size = [20, 20, 1]
    position = [0, 0, -0.5]
    motion = "fixed"
    [[blocks]]
    kind = "box"
    size = [1, 1, 1]
    position = [0, 0, 0.6]
    repeat = { count = 3, step = [0.1, 0.03, 1.05] }
"#;

/// Blocks without a fluid, on the host.
fn simulation() -> Simulation {
    let scene = Scene::from_toml(SCENE, Path::new(""), "scene.toml").expect("a scene");
    let setup = block_setup(&scene).expect("blocks");
    pollster::block_on(Simulation::of_rock(None, &scene, setup))
        .expect("blocks that do not overlap")
}

#[test]
fn a_scene_goes_on_from_a_file_without_a_device() {
    let folder = tempfile::tempdir().expect("a folder to write to");
    let file = folder.path().join("rock.state");
    let mut whole = simulation();
    pollster::block_on(whole.advance(7)).expect("steps");
    let state = pollster::block_on(whole.checkpoint()).expect("a state");
    state.write(&file).expect("a folder to write to");
    pollster::block_on(whole.advance(9)).expect("steps");
    let mut rest = simulation();
    let read = Checkpoint::read(&file).expect("a checkpoint");
    assert_eq!(read, state);
    rest.restore(&read).expect("the same scene");
    pollster::block_on(rest.advance(9)).expect("steps");
    assert_eq!(rest.step(), 16);
    let states = [&mut whole, &mut rest].map(|one| pollster::block_on(one.checkpoint()));
    let [expected, found] = states.map(|state| state.expect("a state"));
    assert!(found == expected && expected != state);
    // Checkpoints of another scene.
    let mut longer = state.clone();
    longer.time_step *= 2.0;
    let error = rest.restore(&longer).expect_err("other steps").to_string();
    assert_contains(&error, &["steps of", "restart with"]);
    let mut wet = state;
    wet.rock = None;
    let error = rest.restore(&wet).expect_err("no blocks").to_string();
    assert!(error.contains("no blocks"), "{error}");
    assert!(pollster::block_on(rest.checkpoint()).expect("a state") == expected);
}
