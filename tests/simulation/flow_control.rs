//! A bulk velocity held by a body force: compared with laminar flow between plates and the balance of forces on a sphere, over
//! restarts, and refusals.

use kit::{Rig, assert_contains, assert_near};
use riprap::{
    scene::{Field, Scene},
    simulation::{Simulation, Totals},
};

const VELOCITY: f64 = 0.05;
const VISCOSITY: f64 = 0.02;
/// Between the plates, m.
const HEIGHT: f64 = 1.2;

/// Plates 12 cells apart.
fn plates() -> Scene {
    channel(HEIGHT, "")
}

/// A channel of a height, m, with more tables.
fn channel(height: f64, more: &str) -> Scene {
    kit::scene::read(&format!(
        r#"
        domain = {{ size = [0.5, 0.3, {height}], cell = 0.1 }}
        fluid = {{ viscosity = {VISCOSITY}, density = 1000, bulk_velocity = [-{VELOCITY}, 0, 0] }}
        numerics.time_step = 0.1
        run.steps = 8000
        [boundaries]
        z_min = {{ kind = "wall" }}
        z_max = {{ kind = "wall" }}
        {more}
        "#
    ))
    .unwrap()
}

fn totals(rig: &Rig, simulation: &mut Simulation) -> Totals {
    rig.wait(simulation.totals()).unwrap()
}

#[test]
fn the_force_of_a_laminar_flow_is_that_of_poiseuille() {
    let rig = Rig::new();
    let mut simulation = rig.simulation(&plates()).unwrap();
    rig.wait(simulation.advance(8000)).unwrap();
    let found = totals(&rig, &mut simulation);
    assert_near(found.bulk_velocity, -VELOCITY, 1e-4 * VELOCITY);
    let expected = -12.0 * VISCOSITY * VELOCITY / HEIGHT.powi(2);
    // Half-way walls are exact to 1 % on 12 cells.
    assert_near(found.driving_acceleration, expected, 0.01 * expected.abs());
}

/// Exact solids with faces in the middle of cells: the mean is over the volume that they leave open.
#[test]
fn the_bulk_velocity_between_exact_solids_is_that_of_the_open_volume() {
    let rig = Rig::new();
    let solids = [(0.15, 1), (0.15 + HEIGHT, -1)].map(|(z, up)| {
        format!(
            r#"
            [[solids]]
            kind = "half_space"
            point = [0, 0, {z}]
            normal = [0, 0, {up}]
            surface = "exact"
            "#
        )
    });
    let scene = channel(HEIGHT + 0.3, &solids.concat());
    let mut simulation = rig.simulation(&scene).unwrap();
    rig.wait(simulation.advance(8000)).unwrap();
    let found = totals(&rig, &mut simulation);
    assert_near(found.bulk_velocity, -VELOCITY, 1e-4 * VELOCITY);
    let mass = 1000.0 * 0.5 * 0.3 * HEIGHT;
    assert_near(found.mass, mass, 1e-3 * mass);
    assert_near(found.momentum[0], -VELOCITY * mass, 1e-3 * VELOCITY * mass);
}

#[test]
fn a_restart_and_other_stretches_go_on_to_the_same_bits() {
    let rig = Rig::new();
    let start = || rig.simulation(&plates()).unwrap();
    let image = |simulation: &mut Simulation| {
        let read = simulation.image(&[Field::Velocity, Field::Pressure]);
        rig.wait(read).unwrap()
    };
    let mut whole = start();
    rig.wait(whole.advance(330)).unwrap();
    let mut cut = start();
    for steps in [1, 48, 2, 99, 100, 7, 1, 22, 20] {
        rig.wait(cut.advance(steps)).unwrap();
    }
    let state = rig.wait(cut.checkpoint()).unwrap();
    let mut restored = start();
    restored.restore(&state).unwrap();
    for simulation in [&mut cut, &mut restored] {
        rig.wait(simulation.advance(30)).unwrap();
        assert_eq!(image(simulation), image(&mut whole));
        assert_eq!(totals(&rig, simulation), totals(&rig, &mut whole));
    }
}

/// A state of the same scene without a bulk velocity has no driving force to continue from.
#[test]
fn a_state_without_control_begins_it_anew() {
    let rig = Rig::new();
    let mut without = plates();
    without.fluid.bulk_velocity = None;
    let state = {
        let mut simulation = rig.simulation(&without).unwrap();
        rig.wait(simulation.checkpoint()).unwrap()
    };
    let mut fresh = rig.simulation(&plates()).unwrap();
    let start = totals(&rig, &mut fresh).driving_acceleration;
    rig.wait(fresh.advance(200)).unwrap();
    assert!(totals(&rig, &mut fresh).driving_acceleration != start);
    fresh.restore(&state).unwrap();
    assert_eq!(totals(&rig, &mut fresh).driving_acceleration, start);
}

/// In a steady flow the force that drives the fluid and the solid in it equals the drag of the solid.
#[test]
fn a_sphere_bears_all_of_the_force() {
    let rig = Rig::new();
    let scene = r#"
        domain = { size = [1.6, 1.6, 1.6], cell = 0.1 }
        fluid = { viscosity = 0.1, density = 1000, bulk_velocity = [0, 0.02, 0] }
        numerics.time_step = 0.01
        run.steps = 5000
        [[materials]]
        name = "rock"
        density = 2650
        normal_stiffness = 1e6
        friction = 30
        [coupling]
        hold = 100
        [[blocks]]
        kind = "sphere"
        radius = 0.45
        position = [0.8, 0.83, 0.77]
        "#;
    let mut simulation = rig.simulation(&kit::scene::read(scene).unwrap()).unwrap();
    rig.wait(simulation.advance(5000)).unwrap();
    let found = totals(&rig, &mut simulation);
    assert_near(found.bulk_velocity, 0.02, 2e-5);
    let load = simulation.coupled().unwrap().external_load()[0];
    let driven = 1000.0 * found.driving_acceleration * 1.6_f64.powi(3);
    assert_near(load.flow.force.y, driven, 0.01 * driven);
    assert!(driven > 0.0);
    // Not even a trial step has moved the block.
    let blocks = simulation.coupled().unwrap().blocks();
    assert_eq!(blocks.peak_speed(), 0.0);
}

#[test]
fn what_it_cannot_keep_is_refused() {
    let refused = |change: &dyn Fn(&mut Scene), part: &str| {
        let mut scene = plates();
        change(&mut scene);
        let error = scene.check().unwrap_err().to_string();
        assert_contains(&error, &["fluid.bulk_velocity", part]);
    };
    refused(
        &|scene| scene.fluid.bulk_velocity = Some([0.0, 0.0, 1.0]),
        "along z, which has boundaries",
    );
    let wrong = "finite numbers of which one is not 0";
    for velocity in [[0.0; 3], [1.0, 1.0, 0.0], [f64::NAN, 0.0, 0.0]] {
        refused(&|scene| scene.fluid.bulk_velocity = Some(velocity), wrong);
    }
    let history = "[[output.histories]]\nquantities = [\"driving_acceleration\"]";
    let without = kit::scene::read(&format!(
        "domain = {{ size = [1, 1, 1], cell = 0.1 }}\nfluid.viscosity = 0.1\nnumerics.time_step = 0.01\n\
         run.steps = 1\n{history}"
    ));
    assert_contains(
        without.unwrap_err(),
        &["output.histories[0].quantities", "driving_acceleration"],
    );
    refused(
        &|scene| scene.fluid.acceleration[0] = "0.1 * z".parse().unwrap(),
        "the same everywhere",
    );
}
