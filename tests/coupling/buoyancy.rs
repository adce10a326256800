//! Blocks in water that stands still.

use crate::fixture::{DENSITY, World, fluid, material};
use glam::DVec3;

/// A closed box with a fixed block of 8 × 6 × 7 m, 16 cells across at its widest, turned and off the grid.
fn closed(nu: f64, water: bool) -> World {
    let acceleration = if water { "[0, 0, -0.01]" } else { "[0, 0, 0]" };
    let text = format!(
        r#"{}{}
        [boundaries]
        x_min = {{ kind = "wall" }}
        x_max = {{ kind = "wall" }}
        y_min = {{ kind = "wall" }}
        y_max = {{ kind = "wall" }}
        z_min = {{ kind = "wall" }}
        z_max = {{ kind = "wall" }}
        [rock]
        gravity = [0, 0, -0.01]
        [numerics]
        time_step = 0.25
        velocity_scale = 0.1
        [[probes]]
        name = "load"
        kind = "block"
        block = "stone"
        [[blocks]]
        name = "stone"
        kind = "box"
        size = [8, 6, 7]
        position = [6.1, 5.9, 6.3]
        rotation = {{ axis = [1, 2, 3], angle = 25 }}
        motion = "fixed""#,
        fluid([24, 24, 24], nu).replace(
            "viscosity",
            &format!("acceleration = {acceleration}\nviscosity")
        ),
        material("rock", 2650.0)
    );
    World::new(&text)
}

/// Smooth ones of a mesh of their own: nearly each cell is cut by dozens of faces, and work for thousands of turns.
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
        assert!((found / volume - 1.0).abs() < 2e-3, "{found} of {volume}");
    }
}

#[test]
fn buoyancy_is_the_weight_of_the_water_at_any_viscosity() {
    let exact = DVec3::Z * DENSITY * 0.01 * 8.0 * 6.0 * 7.0;
    // τ = 0.53, 0.8 and 2; the water heavy, or only its buoyancy acting.
    for (nu, water) in [(0.01, true), (0.1, true), (0.5, true), (0.1, false)] {
        let mut world = closed(nu, water);
        world.advance(60);
        let load = world.cell_load(0);
        let (force, torque) = (
            load.flow.force + load.buoyancy.force,
            load.flow.torque() + load.buoyancy.torque(),
        );
        println!(
            "ν {nu}, heavy water {water}: {force}, {torque}, flow {}",
            load.flow.force
        );
        assert!(
            (force - exact).length() < 0.01 * exact.z,
            "ν {nu}, {water}: {force}"
        );
        // About the centroid there is none: 1 % of the force at the length of an edge.
        assert!(
            torque.length() < 0.01 * exact.z * 7.0,
            "ν {nu}, {water}: {torque}"
        );
    }
}

#[test]
fn a_block_as_heavy_as_the_water_stays() {
    for water in [true, false] {
        let acceleration = if water { "[0, 0, -0.01]" } else { "[0, 0, 0]" };
        let mut world = World::new(&format!(
            r#"{}{}
            [boundaries]
            z_min = {{ kind = "wall" }}
            z_max = {{ kind = "wall" }}
            [rock]
            gravity = [0, 0, -0.01]
            [numerics]
            time_step = 0.25
            velocity_scale = 0.1
            [[blocks]]
            kind = "box"
            size = [3, 2.5, 2.75]
            position = [3.1, 3.3, 4.2]
            rotation = {{ axis = [1, 2, 3], angle = 25 }}"#,
            fluid([14, 14, 16], 0.02).replace(
                "viscosity",
                &format!("acceleration = {acceleration}\nviscosity")
            ),
            material("rock", DENSITY)
        ));
        world.advance(200);
        let way = world.centre(0) - DVec3::new(3.1, 3.3, 4.2);
        println!("{water}: {way}, {}", world.velocity(0));
        // Falling freely for these 50 s it would go 12 m; what it goes is a thousandth of its own size.
        assert!(way.length() < 3e-3, "{water}: {way}");
    }
}
