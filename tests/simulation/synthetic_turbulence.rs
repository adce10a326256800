//! Turbulence at a velocity inlet of a scene: the same eddies however a run is interrupted, and refusals.

use kit::{Rig, assert_contains};
use riprap::{
    scene::{Field, Scene},
    simulation::Simulation,
};

/// A stream that accelerates, with `turbulence` at the inlet.
fn scene(velocity: &str, turbulence: &str) -> riprap::Result<Scene> {
    kit::scene::read(&format!(
        r#"
        domain = {{ size = [1.6, 0.9, 0.7], cell = 0.1 }}
        fluid = {{ viscosity = 1e-3, density = 1000 }}
        numerics.time_step = 5e-3
        run.steps = 100
        [boundaries]
        x_min = {{ kind = "velocity", velocity = [{velocity}, 0, 0], turbulence = {{ {turbulence} }} }}
        x_max = {{ kind = "pressure" }}
        "#
    ))
}

#[test]
fn a_restart_and_other_stretches_go_on_with_the_same_eddies() {
    let rig = Rig::new();
    let scene = scene(
        "\"interpolate(t, 0.1, 1, 0.2, 1.5)\"",
        "intensity = 0.1, length = 0.3",
    )
    .unwrap();
    let start = || rig.simulation(&scene).unwrap();
    let image = |simulation: &mut Simulation| {
        rig.wait(simulation.image(&[Field::Velocity, Field::Pressure]))
            .unwrap()
    };
    let mut whole = start();
    rig.wait(whole.advance(75)).unwrap();
    let mut cut = start();
    for steps in [1, 22, 2, 6] {
        rig.wait(cut.advance(steps)).unwrap();
        image(&mut cut);
    }
    let state = rig.wait(cut.checkpoint()).unwrap();
    let mut restored = start();
    restored.restore(&state).unwrap();
    for simulation in [&mut cut, &mut restored] {
        rig.wait(simulation.advance(44)).unwrap();
        assert_eq!(image(simulation), image(&mut whole));
    }
}

#[test]
fn another_seed_has_other_eddies() {
    let rig = Rig::new();
    let after = |seed: u64| {
        let scene = scene(
            "1",
            &format!("intensity = 0.1, length = 0.3, seed = {seed}"),
        )
        .unwrap();
        let mut simulation = rig.simulation(&scene).unwrap();
        rig.wait(simulation.advance(20)).unwrap();
        rig.wait(simulation.image(&[Field::Velocity])).unwrap()
    };
    let first = after(0);
    assert!(first != after(1));
    assert_eq!(first, after(0));
}

#[test]
fn what_is_no_turbulence_is_refused() {
    let refused = |velocity: &str, turbulence: &str, part: &str| {
        let error = scene(velocity, turbulence).unwrap_err();
        assert_contains(error, &["boundaries.x_min.turbulence", part]);
    };
    refused("1", "intensity = 2, length = 0.3", "intensity");
    refused("1", "intensity = 0, length = 0.3", "intensity");
    refused("1", "intensity = 0.1, length = 0.09", "0.1 m here");
    refused("1", "intensity = 0.1", "length");
    refused("0", "intensity = 0.1, length = 0.3", "no net flow");
}
