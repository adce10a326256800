//! Blocks a few cells thick in water of very low viscosity come to rest in their joints, closed or thinner than a cell. Full
//! cells reflect the populations that leave a joint, and loads are delayed: undamped modes grow until the water in the joint
//! is supersonic.

use crate::fixture::World;

/// Water of 1e-5 m²/s in cells of 0.05 m and steps of 0.48 ms, and rock of 2650 kg/m³.
fn water(size: [f64; 3], gravity: f64, more: &str) -> World {
    World::new(&format!(
        r#"
        domain = {{ size = {size:?}, cell = 0.05 }}
        fluid = {{ viscosity = 1e-5 }}
        numerics = {{ velocity_scale = 6 }}
        rock = {{ gravity = [0, 0, {gravity}] }}
        run = {{ steps = 1 }}
        materials = [{{ name = "rock", density = 2650, normal_stiffness = 4e8, friction = 35, damping = 0.2 }}]
        {more}"#
    ))
}

fn block(size: [f64; 3], position: [f64; 3], velocity: [f64; 3]) -> String {
    format!(
        "[[blocks]]\nkind = \"box\"\nsize = {size:?}\nposition = {position:?}\nvelocity = {velocity:?}\n"
    )
}

/// Speed of the fastest of `blocks` blocks, m/s.
fn fastest(world: &World, blocks: usize) -> f64 {
    let speeds = (0..blocks).map(|n| world.velocity(n).length());
    speeds.fold(0.0, f64::max)
}

/// Both faces lie in one row of cells. Delayed loads, or water between full cells that only the joint damps, would each drive
/// the plates apart at 10 m/s.
#[test]
fn plates_on_both_sides_of_a_thin_gap_come_to_rest() {
    let (gap, thickness) = (0.015, 0.1);
    let plate = |side: f64| {
        let y = 0.525 + 0.5 * side * (thickness + gap);
        block(
            [0.6, thickness, 0.6],
            [0.5, y, 0.5],
            [0.0, 0.02 * side, 0.0],
        )
    };
    let mut world = water([1.0; 3], 0.0, &(plate(-1.0) + &plate(1.0)));
    world.advance(900);
    let speed = fastest(&world, 2);
    println!("{speed} m/s");
    assert!(speed < 1e-3, "{speed}");
}

/// Nearly full cells of one plate are next to cells of the other one. Without a least B there, plates of 0.2 m at 1:2 would
/// accelerate the water between them beyond Mach 0.7 within 850 steps.
#[test]
fn plates_at_an_angle_to_the_grid_come_to_rest() {
    for (gap, thickness, angle) in [(0.02, 0.2, 26.6_f64), (0.025, 0.15, 10.0)] {
        let (sin, cos) = angle.to_radians().sin_cos();
        let plate = |side: f64| {
            let [y, z] = [cos, sin].map(|n| 0.5 * side * (thickness + gap) * n);
            let [vy, vz] = [cos, sin].map(|n| 0.02 * side * n);
            let size = [0.6, thickness, 0.6];
            block(size, [0.5, 0.525 + y, 0.5 + z], [0.0, vy, vz])
                + &format!("rotation = {{ axis = [1, 0, 0], angle = {angle} }}\n")
        };
        let mut world = water([1.0; 3], 0.0, &(plate(-1.0) + &plate(1.0)));
        world.advance(1500);
        let speed = fastest(&world, 2);
        println!("{speed} m/s");
        assert!(speed < 1e-3, "{speed}");
    }
}

/// Speed of the fastest of nine cubes of four cells on a floor, each with another initial velocity, m/s. The side of the first
/// lies at `side` (m).
fn jointed_slab(side: f64, coupling: &str) -> f64 {
    let mut scene = format!(
        r#"
        {coupling}
        [boundaries]
        z_min = {{ kind = "wall" }}
        z_max = {{ kind = "free_slip" }}
        "#,
    );
    for n in 0..9 {
        let [x, y] = [n % 3, n / 3].map(|k| side + 0.1 + 0.2 * f64::from(k));
        let phase = 2.3 * f64::from(n);
        let kick = [phase.sin(), phase.cos(), 0.3].map(|v| 0.08 * v);
        scene += &block([0.2; 3], [x, y, 0.1], kick);
    }
    let mut world = water([1.0, 1.0, 0.5], -9.81, &scene);
    world.advance(500);
    let speed = fastest(&world, 9);
    println!("{speed} m/s");
    speed
}

#[test]
fn blocks_of_a_jointed_slab_come_to_rest() {
    assert!(jointed_slab(0.225, "") < 1e-3);
}

/// The narrowest joints that this lattice allows: in joints of two rows of cells, and in cells that two blocks share.
#[test]
fn blocks_with_the_narrowest_joints_come_to_rest() {
    for side in [0.2, 0.225] {
        assert!(jointed_slab(side, "coupling = { joint_aperture = 0.43e-3 }") < 1e-3);
    }
}
