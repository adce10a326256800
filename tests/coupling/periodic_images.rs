//! Blocks that meet across a periodic face, and lubrication films between blocks.

use crate::fixture::{World, fluid, material};
use glam::DVec3;
use kit::assert_contains;

/// Two boxes that approach each other along x, 16 cells and 8 m long, with the middle of the gap at `x` (m).
pub fn pair(x: f64, lubrication: bool) -> String {
    let at = |offset: f64| (x + offset).rem_euclid(8.0);
    format!(
        r#"{}{}[rock]
        gravity = [0, 0, 0]
        [coupling]
        lubrication = {lubrication}
        [numerics]
        time_step = 0.25
        [[blocks]]
        kind = "box"
        size = [2, 2, 2]
        position = [{}, 2.1, 2.2]
        velocity = [0.1, 0, 0]
        [[blocks]]
        kind = "box"
        size = [2, 2, 2]
        position = [{}, 2.2, 2.1]
        velocity = [-0.1, 0, 0]"#,
        fluid([16, 8, 8], 0.1),
        material("rock", 4000.0),
        at(-1.25),
        at(1.25)
    )
}

#[test]
fn blocks_meet_across_a_periodic_face_as_in_the_middle() {
    let [mut middle, mut across] = [4.0, 8.0].map(|x| World::new(&pair(x, true)));
    let way = DVec3::X * 4.0;
    let mut touched = false;
    for _ in 0..24 {
        for world in [&mut middle, &mut across] {
            world.advance(1);
        }
        let coupled = middle.sim.coupled().unwrap();
        touched |= coupled.blocks().ledger().film > 0.0;
        for block in 0..2 {
            let apart = across.centre(block) - middle.centre(block) - way;
            let apart = apart - 8.0 * (apart / 8.0).round();
            assert!(apart.length() < 1e-6, "block {block}: {apart}");
            let apart = across.velocity(block) - middle.velocity(block);
            assert!(apart.length() < 1e-6, "block {block}: {apart}");
        }
    }
    assert!(touched);
    // Without a film, the gap of half a metre would close after 10 steps.
    let gap = middle.centre(1).x - middle.centre(0).x - 2.0;
    assert!(gap > -1e-3, "{gap}");
}

#[test]
fn films_slow_blocks_down_and_keep_momentum() {
    let [mut with, mut without] = [true, false].map(|on| World::new(&pair(4.0, on)));
    let scale = with.momentum(0).length();
    for world in [&mut with, &mut without] {
        world.advance(11);
        let (of_fluid, _) = world.fluid();
        let whole = of_fluid + world.momentum(0) + world.momentum(1);
        // The sum lacks the part of a step's load that the blocks have not yet received.
        assert!(whole.length() < 2e-2 * scale, "{whole}");
    }
    let closing = |world: &World| world.velocity(0).x - world.velocity(1).x;
    assert!(
        closing(&with) < 0.8 * closing(&without),
        "{} {}",
        closing(&with),
        closing(&without)
    );
    let taken = |world: &World| world.sim.coupled().unwrap().blocks().ledger().film;
    assert!(taken(&with) > 0.0 && taken(&without) == 0.0);
}

#[test]
fn a_block_longer_than_the_domain_is_refused() {
    let text = pair(4.0, true).replacen("size = [2, 2, 2]", "size = [2, 4.2, 2]", 1);
    let Err(error) = World::try_new(&text) else {
        panic!("it was accepted");
    };
    let message = error.to_string();
    assert_contains(&message, &["block_1", "along y"]);
}
