//! Blocks that slide on their support under water: only friction holds them.

use crate::fixture::{DENSITY, WALLS, World, fluid};
use glam::DVec3;

/// Size of the block, m: 8 × 6 × 5 cells.
const SIZE: DVec3 = DVec3::new(4.0, 3.0, 2.5);

/// A closed tank of water at rest, with a bed of height `bed` (m) unless it is 0, and a stone on it.
fn tank(bed: f64, gravity: [f64; 3], friction: f64, stone: &str) -> World {
    let bed_block = match bed > 0.0 {
        true => format!(
            "[[blocks]]\nname = \"bed\"\nkind = \"box\"\nsize = [14, 10, {bed}]\nposition = [7, 5, {}]\nmotion = \"fixed\"\n",
            0.5 * bed
        ),
        false => String::new(),
    };
    World::new(&format!(
        r#"{}
        {WALLS}
        [numerics]
        time_step = 0.25
        velocity_scale = 0.1
        [rock]
        gravity = {gravity:?}
        [[materials]]
        name = "rock"
        density = 2650
        normal_stiffness = 1e5
        friction = {friction}
        damping = 0.2
        [[blocks]]
        name = "stone"
        kind = "box"
        size = {:?}
        position = [4.1, 5.1, {}]
        {stone}
        {bed_block}"#,
        fluid([28, 20, 16], 0.02),
        SIZE.to_array(),
        bed + 0.5 * SIZE.z,
    ))
}

/// Full cells that reflect their populations and add the momentum of their solid would tie a block to its support by a spring
/// of 2 ρ c_s² / Δx per area and length.
#[test]
fn a_block_that_slides_is_not_tied_to_its_bed() {
    let spring = 2.0 / 3.0 * DENSITY * (0.5_f64 / 0.25).powi(2) * SIZE.x * SIZE.y / 0.5;
    // On the floor, and on a bed along the grid and across it.
    for bed in [0.0, 1.0, 1.2] {
        let stone = r#"motion = "driven"
            velocity = ["0.02*max(0, sign(50 - t))", 0, 0]"#;
        let mut world = tank(bed, [0.0; 3], 30.0, stone);
        world.advance(100);
        let slides = world.cell_load(0).flow.force.x;
        world.advance(500);
        let stands = world.cell_load(0).flow.force.x;
        println!("{bed}: {slides}, {stands} N; {spring} N/m");
        // The drag of the stone at 0.02 m/s, and of eddies.
        assert!(slides.abs() < 2e-3 * spring, "{slides}");
        assert!(stands.abs() < 2e-4 * spring, "{stands}");
    }
}

/// A block on a bed of 30° whose friction angle is larger or smaller by one degree.
#[test]
fn submerged_blocks_slide_from_their_friction_on() {
    let gravity = [0.005, 0.0, -0.01 * 30_f64.to_radians().cos()];
    for bed in [0.0, 1.2] {
        let [slips, holds] = [29.0, 31.0].map(|friction| {
            let mut world = tank(bed, gravity, friction, "");
            world.advance(800);
            let way = world.centre(0).x - 4.1;
            println!("{bed}, {friction}: {way} m");
            way
        });
        // The net force is 10 N, the drag of the water at 5 mm/s: 1 m in 200 s.
        assert!((0.2..1.0).contains(&slips), "{slips}");
        assert!(holds.abs() < 0.02, "{holds}");
    }
}
