//! Deformable blocks in a fluid.

use crate::fixture::{WALLS, World, fluid};
use glam::DMat3;

/// Largest difference of the stress of the block 0 from a uniform `pressure`, Pa.
fn stress_error(world: &World, pressure: f64) -> f64 {
    let stress = world.sim.rock().unwrap().blocks().stress(0).unwrap();
    let miss = (stress + DMat3::IDENTITY * pressure).to_cols_array();
    miss.iter()
        .fold(0.0, |most: f64, miss| most.max(miss.abs()))
}

/// A cube on a grid of 6 cells per edge, along it and at an angle to it, in a closed box of water under pressure. The water inside
/// the cube has the same pressure from the start.
#[test]
fn water_under_pressure_compresses_a_block() {
    for angle in [0, 30] {
        let mut world = World::new(&format!(
            r#"{}{WALLS}
            [initial]
            pressure = 0.2
            [rock]
            gravity = [0, 0, 0]
            [numerics]
            time_step = 0.25
            [[materials]]
            name = "rock"
            density = 2000
            normal_stiffness = 1e5
            friction = 30
            youngs_modulus = 1e6
            [[blocks]]
            kind = "box"
            size = [3, 3, 3]
            position = [4, 4, 4]
            rotation = {{ axis = [1, 2, 3], angle = {angle} }}
            deformable = true"#,
            fluid([16, 16, 16], 0.1),
        ));
        world.advance(200);
        let miss = stress_error(&world, 0.2);
        println!("{angle}: {miss} Pa of 0.2");
        assert!(miss < 0.002, "{angle}: {miss}");
    }
}

/// A cube of 6 spacings, held at its centroid 0.3 m under the surface of free water.
#[test]
fn free_water_compresses_a_block() {
    let mut world = World::new(
        r#"
        [domain]
        size = [0.6, 0.5, 0.7]
        [fluid]
        acceleration = [0, 0, -9.81]
        [particles]
        spacing = 0.05
        [boundaries]
        x_min = { kind = "wall" }
        x_max = { kind = "wall" }
        y_min = { kind = "wall" }
        y_max = { kind = "wall" }
        z_min = { kind = "wall" }
        z_max = { kind = "open" }
        [[water]]
        kind = "box"
        size = [0.6, 0.5, 0.6]
        position = [0.3, 0.25, 0.3]
        [rock]
        gravity = [0, 0, -9.81]
        [[materials]]
        name = "rock"
        density = 2500
        normal_stiffness = 1e7
        friction = 35
        youngs_modulus = 1e8
        [[blocks]]
        kind = "box"
        size = [0.3, 0.3, 0.3]
        position = [0.3, 0.25, 0.3]
        deformable = true
        fixed_points = [{ point = [0, 0, 0] }, { point = [0.1, 0, 0], axes = ["y", "z"] }, { point = [0, 0.1, 0], axes = ["z"] }]
        [run]
        duration = 0.2"#,
    );
    let pressure = 9810.0 * 0.3;
    for _ in 0..4 {
        world.advance(10);
        let miss = stress_error(&world, pressure) / pressure;
        println!("{miss}");
        assert!(miss < 0.04, "{miss}");
    }
}

/// A cube that starts to move in water at rest, elastic and rigid. Its strains vibrate with 0.4 to 8 radians per step. The load of
/// the fluid lags behind them and must not drive them: the strain energy stays far below the kinetic energy of the start, and the
/// cube moves as the rigid one.
#[test]
fn the_lag_of_the_loads_drives_no_vibration() {
    let moved = |young: Option<f64>| {
        let modulus = young.map_or(String::new(), |e| format!("youngs_modulus = {e}"));
        let mut world = World::new(&format!(
            r#"{}
            [rock]
            gravity = [0, 0, 0]
            [numerics]
            time_step = 0.25
            velocity_scale = 0.1
            [[materials]]
            name = "rock"
            density = 2000
            normal_stiffness = 1e5
            friction = 30
            {modulus}
            [[blocks]]
            kind = "box"
            size = [4, 4, 4]
            position = [4.07, 4, 4]
            velocity = [0.1, 0, 0]
            deformable = {}"#,
            fluid([20, 16, 16], 0.01),
            young.is_some()
        ));
        let energy = 0.5 * 2000.0 * 64.0 * 0.01;
        for _ in 0..60 {
            world.advance(10);
            let strain = world.sim.coupled().unwrap().blocks().strain_energy(0);
            let strain = strain.unwrap_or_default();
            assert!(
                strain < 5e-2 * energy,
                "{young:?}: {strain} J of {energy} J"
            );
        }
        world.velocity(0).x
    };
    let rigid = moved(None);
    for ratio in [0.4, 1.0, 2.0, 3.0, 5.0, 8.0] {
        // Of the uniform strain, with Poisson's ratio 0.25: ω² = 24 E/ρ a².
        let omega = ratio / 0.25;
        let young = omega * omega * 2000.0 * 16.0 / 24.0;
        let found = moved(Some(young));
        println!("{ratio}: {found}, rigid {rigid}");
        assert!(
            (found - rigid).abs() < 0.02 * 0.1,
            "{ratio}: {found} {rigid}"
        );
    }
}
