//! A light block in still water that is pushed until its base lifts slightly off its support: the fluid in a gap of a few
//! thousandths of a cell must not shake it.

use crate::fixture::{WALLS, World};

/// A slab of 8 × 8 × 5 cells on a floor, or on a block of height `bed`, pushed at half its height with three quarters of the
/// toppling force; a cell is 1 m, a step 1 s and the fluid has 1 kg/m³.
fn slab(bed: f64) -> World {
    const HEIGHT: f64 = 5.0;
    const WIDTH: f64 = 8.0;
    // Submerged weight over mass, times the slope at which the slab topples.
    let push = 0.75 * 0.5 * 1e-4 * WIDTH / HEIGHT;
    let bed_block = match bed > 0.0 {
        true => format!(
            "[[blocks]]\nkind = \"box\"\nsize = [20, 20, {bed}]\nposition = [8, 8, {}]\nmotion = \"fixed\"\n",
            0.5 * bed
        ),
        false => String::new(),
    };
    World::new(&format!(
        r#"
        domain = {{ size = [16, 16, 14], cell = 1 }}
        fluid = {{ density = 1, viscosity = 0.1 }}
        numerics = {{ time_step = 1, velocity_scale = 0.03 }}
        rock = {{ gravity = [0, 0, -1e-4] }}
        run = {{ steps = 1 }}
        materials = [{{ name = "rock", density = 2, normal_stiffness = 0.5, friction = 60 }}]
        {WALLS}
        [[blocks]]
        kind = "box"
        size = [{WIDTH}, {WIDTH}, {HEIGHT}]
        position = [8, 8, {}]
        acceleration = ["{push}*min(1, t/400)", 0, 0]
        {bed_block}"#,
        bed + 0.5 * HEIGHT,
    ))
}

/// Nearly full cells that reflect their populations act as a spring that is a step late; its force grew to forty times the
/// submerged weight in 1700 steps.
#[test]
fn a_block_that_lifts_off_its_bed_comes_to_rest() {
    const WEIGHT: f64 = 8.0 * 8.0 * 5.0 * 1e-4;
    for bed in [0.0, 2.2] {
        let mut world = slab(bed);
        world.advance(1500);
        let lifted = world.centre(0).z - bed - 2.5;
        let mut swing = [f64::INFINITY, f64::NEG_INFINITY];
        for _ in 0..50 {
            world.advance(1);
            let force = world.cell_load(0).flow.force.z;
            swing = [swing[0].min(force), swing[1].max(force)];
        }
        let swing = (swing[1] - swing[0]) / WEIGHT;
        println!("{bed}: lifted by {lifted}, swings by {swing} of its weight");
        assert!((5e-4..1e-2).contains(&lifted), "{lifted}");
        assert!(swing < 1e-2, "{swing}");
    }
}
