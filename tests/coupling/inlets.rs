//! Blocks at inlets: reported before the run and at its end.

use crate::fixture::{World, fluid, material};
use kit::assert_contains;
use riprap::{Error, scene::Warning};

/// A duct with a box of 2 m at `x` and the given inlet velocity.
fn duct(velocity: &str, x: f64, motion: &str) -> World {
    World::new(&duct_scene(velocity, x, motion))
}

/// The scene of [`duct`].
pub fn duct_scene(velocity: &str, x: f64, motion: &str) -> String {
    format!(
        r#"{}{}
        [boundaries]
        x_min = {{ kind = "velocity", velocity = [{velocity}, 0, 0] }}
        x_max = {{ kind = "pressure" }}
        [rock]
        gravity = [0, 0, 0]
        [numerics]
        time_step = 0.25
        velocity_scale = 0.15
        [[blocks]]
        name = "pier"
        kind = "box"
        size = [2, 2, 2]
        position = [{x}, 2, 2]
        {motion}"#,
        fluid([16, 8, 8], 0.02),
        material("rock", 2650.0)
    )
}

fn warnings(world: &World) -> Vec<&Warning> {
    let advice = world.sim.advice().iter();
    advice.filter(|w| w.place == "boundaries.x_min").collect()
}

const FIXED: &str = "motion = \"fixed\"";

#[test]
fn a_block_across_an_inlet_is_warned_of_and_named_when_the_flow_diverges() {
    let mut world = duct("0.1", 0.6, FIXED);
    let told = warnings(&world)[0].message.clone();
    // 4 × 4 cells are full.
    assert_contains(
        &told,
        &["pier", "16 cells", "(0, 2, 2)", "1.000e-1 m/s", "formula"],
    );
    let error = world.try_advance(400).unwrap_err();
    assert!(matches!(error, Error::Diverged { .. }), "{error}");
    let text = error.to_string();
    assert_contains(&text, &["pier", "x_min", "cell (0, 2, 2)", "away from"]);
}

#[test]
fn a_block_that_comes_to_an_inlet_is_named_when_the_flow_diverges() {
    let driven = "motion = \"driven\"\nvelocity = [-0.1, 0, 0]";
    let mut world = duct("0.1", 2.2, driven);
    assert_eq!(warnings(&world).len(), 0);
    let text = world.try_advance(400).unwrap_err().to_string();
    assert_contains(&text, &["pier", "x_min", "blocks an inflow"]);
}

#[test]
fn nothing_is_said_where_nothing_enters() {
    // Nothing enters below 3 m, the top of the box; the next cell centre is at 3.25 m.
    let mut world = duct("\"0.1*max(0, y - 3)\"", 0.6, FIXED);
    assert_eq!(warnings(&world), Vec::<&Warning>::new());
    world.advance(60);
    assert_eq!(warnings(&duct("0.1", 2.2, FIXED)).len(), 0);
}

#[test]
fn what_enters_later_counts() {
    // Runs of one step are long enough for velocities that grow with time.
    let world = duct("\"0.1*t\"", 0.6, FIXED);
    assert_eq!(warnings(&world).len(), 1);
}
