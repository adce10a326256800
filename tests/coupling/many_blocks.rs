//! Many blocks.

use crate::fixture::{DENSITY, World, fluid, material};
use glam::DVec3;

/// 100 blocks of 4 cells an edge fill three tenths of a periodic box, driven together by their first velocities.
#[test]
fn a_hundred_blocks_keep_their_momentum_and_their_memory() {
    let mut world = World::new(&format!(
        r#"{}{}
        [rock]
        gravity = [0, 0, 0]
        [numerics]
        time_step = 0.25
        eddy_viscosity = "wale"
        velocity_scale = 0.1
        [[blocks]]
        kind = "box"
        size = [2, 2, 2]
        position = [1.4, 1.4, 1.4]
        rotation = {{ axis = [1, 1, 0.5], angle = 12 }}
        velocity = [0.04, 0.02, -0.01]
        spin = [0, 0, 0.02]
        repeat = [{{ count = 5, step = [2.8, 0, 0] }}, {{ count = 5, step = [0, 2.8, 0.1] }}, {{ count = 2, step = [0.3, 0.2, 5.6] }}]
        [[blocks]]
        kind = "sphere"
        radius = 1.2407
        position = [1.6, 1.5, 4.2]
        velocity = [-0.03, 0, 0.02]
        repeat = [{{ count = 5, step = [2.8, 0, 0] }}, {{ count = 5, step = [0, 2.8, 0.1] }}, {{ count = 2, step = [0.1, 0.2, 5.6] }}]"#,
        fluid([28, 28, 28], 0.02),
        material("rock", 2650.0)
    ));
    let count = 100;
    let volume = 8.0 * f64::from(count);
    assert!((volume / 14f64.powi(3) - 0.29).abs() < 0.01);
    let all = |world: &mut World| {
        let one = |n: usize| world.momentum(n) - DENSITY * 8.0 * world.velocity(n);
        let rock: DVec3 = (0..count as usize).map(one).sum();
        world.fluid().0 + rock
    };
    let speed = |world: &World| -> f64 {
        let sum: f64 = (0..count as usize)
            .map(|n| world.velocity(n).length())
            .sum();
        sum / f64::from(count)
    };
    let start = all(&mut world);
    let mass = world.fluid().1;
    let speed_then = speed(&world);
    world.advance(40);
    let bytes = world.sim.coupled().unwrap().solid_cells().bytes();
    world.advance(160);
    let end = all(&mut world);
    println!("{start} {end}, speed {speed_then} to {}", speed(&world));
    // What is on its way is three times what the fluid inside gets in a step, and half a load.
    assert!(
        (end - start).length() < 0.03 * start.length(),
        "{start} {end}"
    );
    assert!((world.fluid().1 / mass - 1.0).abs() < 1e-5);
    assert!(speed(&world) < 0.8 * speed_then);
    let grown = world.sim.coupled().unwrap().solid_cells().bytes();
    assert!(grown <= bytes + bytes / 2, "{bytes} B grew to {grown} B");
}
