//! External load of the fluid on a block, without the inertia of the fluid inside its cells.

use crate::fixture::{DENSITY, STEP, World, fluid, material};
use glam::DVec3;
use riprap::coupling::FluidLoad;
use std::f64::consts::PI;

fn around(world: &World, block: usize) -> FluidLoad {
    world.sim.coupled().unwrap().external_load()[block]
}

/// m dv/dt is the external load plus the weight, also in the steps after a restart.
#[test]
fn a_free_block_moves_as_what_it_is_told_to_feel() {
    let scene = format!(
        r#"{}{}
        [rock]
        gravity = [0, 0, -0.01]
        [numerics]
        time_step = 0.25
        [boundaries]
        z_min = {{ kind = "wall" }}
        z_max = {{ kind = "wall" }}
        [[blocks]]
        kind = "sphere"
        radius = 1.4
        position = [3, 3, 4]
        velocity = [0.02, 0, 0]"#,
        fluid([12, 12, 16], 0.02),
        material("rock", 1500.0)
    );
    let mut world = World::new(&scene);
    let mass = 1500.0 * 4.0 / 3.0 * PI * 1.4_f64.powi(3);
    let mut moved = 0.0_f64;
    for step in 1..=24 {
        let before = world.velocity(0);
        world.advance(1);
        let gained = mass * (world.velocity(0) - before);
        let FluidLoad { flow, buoyancy } = around(&world, 0);
        let given = STEP * (flow.force + buoyancy.force - 0.01 * mass * DVec3::Z);
        assert!(
            (gained - given).length() < 1e-6 * given.length().max(1.0),
            "step {step}: {gained}, not {given}"
        );
        moved = moved.max((flow.force - world.cell_load(0).flow.force).length());
    }
    assert!(moved > 1.0, "the fluid inside has no inertia: {moved} N");
}

/// Fluid in free fall has no pressure, and a block that is driven along with it has no load; if the acceleration of the fluid
/// represents a pressure gradient, the load is that on the displaced fluid.
#[test]
fn a_block_that_is_driven_along_with_the_fluid_feels_what_fluid_would() {
    let weight = DENSITY * 2.4 * 2.1 * 1.9 * 0.004;
    for (gravity, feels) in [(0.004, 0.0), (0.0, weight)] {
        let scene = format!(
            r#"{}{}
            [rock]
            gravity = [{gravity}, 0, 0]
            [numerics]
            time_step = 0.25
            [[blocks]]
            kind = "box"
            size = [2.4, 2.1, 1.9]
            position = [3, 3, 3]
            rotation = {{ axis = [1, 2, 3], angle = 40 }}
            motion = "driven"
            velocity = ["0.004 * t", 0, 0]"#,
            fluid([12, 12, 12], 0.02).replace("[run]", "acceleration = [0.004, 0, 0]\n[run]"),
            material("rock", 2000.0)
        );
        let mut world = World::new(&scene);
        world.advance(40);
        let FluidLoad { flow, buoyancy } = around(&world, 0);
        let off = flow.force + buoyancy.force - feels * DVec3::X;
        assert!(off.length() < 2e-3 * weight, "{off} of {weight} N");
    }
}
