//! Deformable blocks in a fluid.

use crate::fixture::{World, fluid};

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
