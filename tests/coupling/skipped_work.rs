//! Steps skip unnecessary work.

use crate::fixture::{World, fluid, material, resting};
use kit::assert_relative;
use riprap::coupling::Exchanges;

fn exchanges(world: &World) -> Exchanges {
    world.sim.coupled().unwrap().exchanges()
}

/// A block on the floor in water at rest, and a fixed one next to it.
#[test]
fn blocks_that_rest_cost_a_look_now_and_then() {
    let mut world = World::new(&resting(
        r#"[[blocks]]
        kind = "sphere"
        radius = 1
        position = [5, 5, 2]
        motion = "fixed""#,
    ));
    world.advance(150);
    let before = exchanges(&world);
    assert!(
        world
            .sim
            .coupled()
            .unwrap()
            .blocks()
            .asleep()
            .any(|asleep| asleep)
    );
    assert!(before.readings < 150 && before.cells.tiles > 0);
    world.advance(160);
    let after = exchanges(&world);
    assert_eq!(after.readings, before.readings + 10);
    assert_eq!(after.cells, before.cells);

    // The same after a restart between two readbacks.
    world.advance(5);
    let saved = world.rig.wait(world.sim.checkpoint()).unwrap();
    let run = |world: &mut World| {
        world.sim.restore(&saved).unwrap();
        world.advance(40);
        world.rig.wait(world.sim.checkpoint()).unwrap()
    };
    world.advance(3);
    let first = run(&mut world);
    assert!(run(&mut world) == first);
}

#[test]
fn fixed_blocks_are_read_where_somebody_asks() {
    let text = format!(
        r#"{}{}
        [numerics]
        time_step = 0.25
        [initial]
        velocity = [0.1, 0, 0]
        [[blocks]]
        kind = "box"
        size = [2, 2, 2]
        position = [2, 3, 2]
        motion = "fixed"
        name = "pier""#,
        fluid([12, 12, 8], 0.1),
        material("rock", 2000.0)
    );
    let mut world = World::new(&text);
    world.advance(20);
    let once = exchanges(&world);
    assert_eq!((once.readings, once.cells.searches), (0, 1));
    world.advance(20);
    assert_eq!(exchanges(&world), once);

    let asked = "[[probes]]\nname = \"drag\"\nkind = \"block\"\nblock = \"pier\"\n";
    let mut world = World::new(&format!("{text}\n{asked}"));
    world.advance(20);
    world.advance(20);
    assert_eq!(exchanges(&world).readings, 2);
    assert_eq!(exchanges(&world).cells, once.cells);
    assert!(world.cell_load(0).flow.force.x > 0.0);
}

/// Keeping poses constant for four steps changes the drag as little as the block moves in that time.
#[test]
fn rare_exchanges_settle_a_block_like_frequent_ones() {
    let fall = |interval: u32| {
        let mut world = World::new(&format!(
            r#"{}{}
            [rock]
            gravity = [0, 0, -0.005]
            [coupling]
            interval = {interval}
            [numerics]
            time_step = 0.25
            velocity_scale = 0.1
            [[blocks]]
            kind = "sphere"
            radius = 1.5
            position = [4, 4, 6]"#,
            fluid([16, 16, 16], 0.05),
            material("rock", 2000.0)
        ));
        let readings = 160 / u64::from(interval);
        world.advance(160);
        assert_eq!(exchanges(&world).readings, readings);
        (world.velocity(0).z, world.centre(0).z - 6.0)
    };
    let (often, rarely) = (fall(1), fall(4));
    println!("velocity and way, every step {often:?}, every fourth {rarely:?}");
    assert!(often.0 < -0.02 && often.1 < -0.5, "{often:?}");
    assert_relative(rarely.0, often.0, 0.02);
    assert_relative(rarely.1, often.1, 0.05);
}
