//! Blocks at periodic faces, at walls and in corners.

use crate::fixture::{STEP, World, fluid, material};

const DRIVEN: &str = r#"
    motion = "driven"
    velocity = [0.05, 0.03, -0.02]
    spin = [0.02, 0.03, 0.05]
"#;

/// A driven box of 3 × 2 × 2.5 m at a place in a periodic box.
fn periodic(position: [f64; 3]) -> World {
    World::new(&format!(
        r#"{}{}
        [rock]
        gravity = [0, 0, 0]
        [numerics]
        time_step = 0.25
        eddy_viscosity = "wale"
        [[blocks]]
        kind = "box"
        size = [3, 2, 2.5]
        position = {position:?}
        rotation = {{ axis = [1, 2, 3], angle = 25 }}
        {DRIVEN}"#,
        fluid([12, 12, 12], 0.05),
        material("rock", 2000.0)
    ))
}

#[test]
fn borders_that_are_periodic_are_none() {
    let (mut middle, mut border) = (periodic([3.1, 3.2, 2.9]), periodic([5.6, 5.7, 0.4]));
    for step in 1..=25 {
        middle.advance(1);
        border.advance(1);
        let (a, b) = (middle.cell_load(0).flow, border.cell_load(0).flow);
        // Sums in another order.
        let off = (a.force - b.force).length() / a.force.length().max(1.0);
        assert!(off < 1e-4, "step {step}: {} and {}", a.force, b.force);
        let off = (a.torque() - b.torque()).length() / a.torque().length().max(1.0);
        assert!(off < 1e-4, "step {step}: {} and {}", a.torque(), b.torque());
    }
}

/// Walls, an inlet and an outflow; driven blocks that overlap each other and a wall, one that is much longer than the
/// domain, one that spins so that its corners go at Mach 0.3, and one that leaves through the outflow.
#[test]
fn blocks_anywhere_leave_the_flow_whole() {
    let mut world = World::new(&format!(
        r#"{}{}
        [boundaries]
        x_min = {{ kind = "velocity", velocity = [0.1, 0, 0] }}
        x_max = {{ kind = "pressure" }}
        y_min = {{ kind = "wall" }}
        y_max = {{ kind = "free_slip" }}
        [initial]
        velocity = [0.1, 0, 0]
        [rock]
        gravity = [0, 0, 0]
        largest_overlap = 10
        [numerics]
        time_step = 0.25
        eddy_viscosity = "wale"
        [[probes]]
        name = "p"
        kind = "block"
        block = "slab"
        [[blocks]]
        name = "slab"
        kind = "box"
        size = [40, 1, 5]
        position = [23, 5.6, 3]
        motion = "fixed"
        [[blocks]]
        name = "leaves"
        kind = "sphere"
        radius = 1.1
        position = [11, 2.5, 3]
        motion = "driven"
        velocity = [0.25, 0, 0]
        [[blocks]]
        name = "spins"
        kind = "box"
        size = [2, 1.5, 1]
        position = [7, 2.5, 2]
        motion = "driven"
        spin = [0, 0, 0.25]
        [[blocks]]
        name = "presses"
        kind = "box"
        size = [1.5, 1.5, 1.5]
        position = [4, 0.9, 4]
        motion = "driven"
        velocity = [0, -0.01, 0]
        [[blocks]]
        name = "into"
        kind = "sphere"
        radius = 1
        position = [4, 2.8, 4]
        motion = "driven"
        velocity = [0, -0.02, 0]"#,
        fluid([28, 12, 12], 0.02),
        material("rock", 2000.0)
    ));
    for _ in 0..12 {
        world.advance(10);
        for block in 0..5 {
            let load = world.cell_load(block);
            assert!(
                load.flow.force.is_finite() && load.flow.moment.is_finite(),
                "{block}"
            );
        }
    }
    // In 30 s it has gone 7.5 m.
    assert!(world.centre(1).x > 18.0);
    assert_eq!(world.cell_load(1).flow, riprap::geometry::Load::default());
    // Only what lies in the domain counts of the slab.
    let slab = world.cell_load(0).flow;
    let inside = slab.entrained + slab.missing;
    assert!((inside - 11.0 * 0.9 * 5.0).abs() < 0.1, "{inside}");
}

/// A free block that flies out of the domain goes on with the velocity that it has.
#[test]
fn blocks_that_have_left_feel_nothing() {
    let mut world = World::new(&format!(
        r#"{}{}
        [boundaries]
        x_min = {{ kind = "velocity", velocity = [0.02, 0, 0] }}
        x_max = {{ kind = "pressure" }}
        [rock]
        gravity = [0, 0, 0]
        [numerics]
        time_step = 0.25
        velocity_scale = 0.2
        [[blocks]]
        kind = "box"
        size = [1.5, 1.5, 1.5]
        position = [4.2, 2, 2]
        velocity = [0.2, 0, 0]
        spin = [0, 0, 0.1]"#,
        fluid([12, 8, 8], 0.02),
        material("rock", 8000.0)
    ));
    world.advance(110);
    let (velocity, centre) = (world.velocity(0), world.centre(0));
    assert!(centre.x > 7.5 && velocity.x > 0.08, "{centre} {velocity}");
    world.advance(40);
    assert_eq!(world.velocity(0), velocity);
    let way = world.centre(0) - centre - 40.0 * STEP * velocity;
    assert!(way.length() < 1e-9);
    assert_eq!(world.sim.coupled().unwrap().solid_cells().tiles(), 0);
}
