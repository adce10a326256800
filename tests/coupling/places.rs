//! Blocks at periodic faces, at walls and in corners; blocks with many faces.

use crate::fixture::{DENSITY, STEP, World, fluid, material};
use glam::DVec3;
use kit::{assert_near, assert_relative};

const DRIVEN: &str = r#"
    motion = "driven"
    velocity = [0.05, 0.03, -0.02]
    spin = [0.02, 0.03, 0.05]
"#;

/// A driven box of 3 × 2 × 2.5 m at a position in a periodic box.
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

/// At the start the fluid has the momentum of the block's volume, also where its faces are in the middle of cells.
#[test]
fn water_inside_a_block_starts_with_its_velocity() {
    for place in [3.0, 3.25] {
        let scene = format!(
            r#"{}{}
            [rock]
            gravity = [0, 0, 0]
            [numerics]
            time_step = 0.25
            [[blocks]]
            kind = "box"
            size = [2, 2.5, 2]
            position = [3, {place}, 3]
            motion = "driven"
            velocity = [0.05, 0.03, -0.02]"#,
            fluid([12, 12, 12], 0.05),
            material("rock", 2000.0)
        );
        let (momentum, _) = World::new(&scene).fluid();
        let expected = 1000.0 * 10.0 * DVec3::new(0.05, 0.03, -0.02);
        assert!((momentum - expected).length() < 1e-3, "{place}: {momentum}");
    }
}

#[test]
fn borders_that_are_periodic_are_none() {
    let (mut middle, mut border) = (periodic([3.1, 3.2, 2.9]), periodic([5.6, 5.7, 0.4]));
    for step in 1..=25 {
        middle.advance(1);
        border.advance(1);
        let (a, b) = (middle.cell_load(0).flow, border.cell_load(0).flow);
        // The order of summation differs.
        let off = (a.force - b.force).length() / a.force.length().max(1.0);
        assert!(off < 1e-4, "step {step}: {} and {}", a.force, b.force);
        let off = (a.torque() - b.torque()).length() / a.torque().length().max(1.0);
        assert!(off < 1e-4, "step {step}: {} and {}", a.torque(), b.torque());
    }
}

/// Walls, an inlet and an outflow; driven blocks that overlap each other and a wall, one that is much longer than the
/// domain, one whose spin moves its corners at Mach 0.3, and one that leaves through the outflow.
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
    // The block has moved 7.5 m in 30 s.
    assert!(world.centre(1).x > 18.0);
    assert_eq!(world.cell_load(1).flow, riprap::geometry::Load::default());
    // Only the part of the slab inside the domain counts.
    let slab = world.cell_load(0).flow;
    let inside = slab.entrained + slab.missing;
    assert_near(inside, 11.0 * 0.9 * 5.0, 0.1);
}

/// A free block that flies out of the domain continues with its velocity.
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

/// Smooth pebbles with a mesh of many faces: dozens of faces cut nearly every cell, which takes thousands of iterations.
#[test]
fn a_pebble_of_many_faces_displaces_its_volume() {
    let rest =
        "[rock]\ngravity = [0, 0, -0.01]\n[numerics]\ntime_step = 0.25\nvelocity_scale = 0.1\n";
    for (faces, radius) in [(520, 2.6), (900, 2.1), (4000, 1.4)] {
        // Normals on a spiral with the golden angle.
        let normal = |k: u32| {
            let z = 1.0 - f64::from(2 * k + 1) / f64::from(faces);
            let (s, c) = (2.399963229728653 * f64::from(k)).sin_cos();
            let rho = (1.0 - z * z).sqrt();
            format!(
                "{{ normal = [{}, {}, {z}], distance = {radius} }}",
                rho * c,
                rho * s
            )
        };
        let planes: Vec<String> = (0..faces).map(normal).collect();
        let text = format!(
            r#"{}{}{rest}
            [[blocks]]
            name = "pebble"
            kind = "half_spaces"
            faces = [{}]
            position = [4.1, 3.9, 4.05]
            motion = "driven""#,
            fluid([16; 3], 0.1),
            material("rock", 2650.0),
            planes.join(", ")
        );
        let mut world = World::new(&text);
        world.advance(1);
        let coupled = world.sim.coupled().unwrap();
        let volume = coupled.blocks().mass(0) / 2650.0;
        let found = world.cell_load(0).buoyancy.force.z / (DENSITY * 0.01);
        println!("{faces} faces: {found} of {volume} m³");
        assert_relative(found, volume, 2e-3);
    }
}
