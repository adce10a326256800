//! Closed joints: their load on a block is the pressure at the rim, once the initial pressure inside has equalised.

use crate::fixture::{DENSITY, WALLS, World, accelerated_fluid, fluid, material};
use glam::DVec3;
use kit::assert_relative;

/// The factors of safety of a block called stone.
const SAFETY: &str = r#"
    [numerics]
    time_step = 0.25
    velocity_scale = 0.1
    [[probes]]
    name = "load"
    kind = "block"
    block = "stone"
    safety = true
"#;
/// Size of the block along the grid (cells of half a metre), m.
const SIZE: DVec3 = DVec3::new(8.0, 6.0, 5.0);

/// The block on the bottom of the tank.
fn stone(size: DVec3, motion: &str) -> String {
    format!(
        r#"[[blocks]]
        name = "stone"
        kind = "box"
        size = {:?}
        position = [6, 6, {}]
        motion = "{motion}""#,
        size.to_array(),
        0.5 * size.z
    )
}

/// A closed tank of 12 m along an edge with water at rest under `acceleration`, and a block on its bottom. Within a box of SIZE,
/// the initial pressure is higher by `stale` (Pa).
fn tank(acceleration: [f64; 3], gravity: [f64; 3], stale: f64, block: &str) -> World {
    let [x, y, z] = acceleration.map(|a| DENSITY * a);
    // 1 in the box, 0 outside it.
    let inside = "max(0, sign(4 - abs(x - 6)))*max(0, sign(3 - abs(y - 6)))*max(0, sign(5 - z))";
    let mut world = World::new(&format!(
        r#"{}{}
        {WALLS}
        [initial]
        pressure = "{x}*x + {y}*y + {z}*(z - 12) + {stale}*{inside}"
        [rock]
        gravity = {gravity:?}
        {SAFETY}
        {block}"#,
        accelerated_fluid([24; 3], 0.1, acceleration),
        material("rock", 2650.0),
    ));
    world.advance(400);
    world
}

/// The uplift equals the buoyancy under any gravity, also with pressure relative to the hydrostatic pressure, up to the rounding
/// of pressures over the head, and for any initial pressure inside. So does the load on the block.
#[test]
fn in_still_water_the_base_carries_the_pressure_of_its_rim() {
    let heavy = [0.0, 0.0, -0.01];
    let oblique = [0.003, -0.002, -0.01];
    let volume = SIZE.element_product();
    for (acceleration, gravity) in [(heavy, heavy), (oblique, oblique), ([0.0; 3], heavy)] {
        for stale in [0.0, 40.0] {
            let mut world = tank(acceleration, gravity, stale, &stone(SIZE, "fixed"));
            // Until the initial pressure inside has equalised.
            world.advance(if stale > 0.0 { 800 } else { 0 });
            let coupled = world.sim.coupled().unwrap();
            let [force, torque] = coupled.wrench_with_uplift(0).unwrap();
            let exact = -DENSITY * volume * DVec3::from(gravity);
            let load = world.cell_load(0);
            let whole = load.flow.force + load.buoyancy.force;
            println!("{acceleration:?}, {stale}: {force}, {torque}; {exact}; {whole}");
            assert!((force - exact).length() < 1e-4 * exact.length());
            // A sum over cells lacks h²/12 of each face's ∫ r².
            assert!(torque.length() < 5e-4 * exact.length() * SIZE.x);
            assert!((whole - exact).length() < 1e-2 * exact.length());
        }
    }
}

/// Sides that rows of cells do not fill, and sides of one row, which determine no slopes. Pressures are relative to the
/// surface, so that all pressures at the bottom are far from 0.
#[test]
fn the_base_of_a_block_across_the_grid_carries_the_pressure_of_its_rim() {
    let heavy = [0.0, 0.0, -0.01];
    let sizes = [
        DVec3::new(8.0, 6.0, 5.2),
        DVec3::new(7.7, 5.6, 4.9),
        DVec3::new(8.0, 6.0, 0.5),
        DVec3::new(7.7, 5.6, 0.7),
    ];
    for size in sizes {
        let world = tank(heavy, heavy, 0.0, &stone(size, "fixed"));
        let coupled = world.sim.coupled().unwrap();
        let [force, torque] = coupled.wrench_with_uplift(0).unwrap();
        let exact = DENSITY * 0.01 * size.element_product();
        // The head above the block, times its base.
        let head = DENSITY * 0.01 * 12.0 * size.x * size.y;
        println!("{size}: {force}, {torque}; {exact}, {head}");
        assert!((force - DVec3::Z * exact).length() < 1e-5 * head);
        assert!(torque.length() < 1e-5 * head * size.x);
    }
}

/// Two boxes that form an L, whose seam is neither wet nor a joint.
#[test]
fn seams_of_a_compound_carry_nothing() {
    let heavy = [0.0, 0.0, -0.01];
    let compound = r#"[[blocks]]
        name = "stone"
        kind = "compound"
        position = [6, 6, 0]
        motion = "fixed"
        parts = [
            { kind = "box", size = [6, 4, 2], position = [0, 0, 1] },
            { kind = "box", size = [2, 4, 3], position = [-2, 0, 3.5] },
        ]"#;
    let world = tank(heavy, heavy, 0.0, compound);
    let coupled = world.sim.coupled().unwrap();
    let [force, torque] = coupled.wrench_with_uplift(0).unwrap();
    let volume = 48.0 + 24.0;
    let exact = DVec3::Z * DENSITY * 0.01 * volume;
    println!("{force}, {torque}; {exact}");
    assert!((force - exact).length() < 1e-5 * exact.length());
    // Buoyancy acts through the centroid.
    assert!(torque.length() < 1e-5 * exact.length() * 6.0, "{torque}");
}

/// A pressure inside that would lift the block at 0.0028 m/s²; the block is held until it has equalised.
#[test]
fn what_was_inside_at_the_start_moves_no_block() {
    let heavy = [0.0, 0.0, -0.01];
    let held = format!("{}\n[coupling]\nhold = 95", stone(SIZE, "free"));
    let world = tank(heavy, heavy, 120.0, &held);
    let centre = world.sim.coupled().unwrap().blocks().poses()[0].centre;
    let moved = (centre - DVec3::new(6.0, 6.0, 2.5)).length();
    // The block sinks in by 0.8 mm due to its weight, and by twice that at first.
    assert!(moved < 2e-3, "{moved} m");
}

/// A joint that closes during the run: the pressure of the squeezed water does not remain in it.
#[test]
fn a_block_that_lands_has_the_push_of_archimedes() {
    let heavy = [0.0, 0.0, -0.01];
    let size = DVec3::new(4.0, 3.0, 2.5);
    for bed in [0.0, 1.2] {
        let blocks = format!(
            r#"[[blocks]]
            name = "stone"
            kind = "box"
            size = {:?}
            position = [6, 6, {}]
            motion = "driven"
            velocity = [0, 0, "-0.02*max(0, sign(60 - t))"]
            [[blocks]]
            name = "bed"
            kind = "box"
            size = [12, 12, {}]
            position = [6, 6, {}]
            motion = "fixed""#,
            size.to_array(),
            bed + 1.2 + 0.5 * size.z,
            bed.max(0.1),
            0.5 * bed.max(0.1) - if bed > 0.0 { 0.0 } else { 0.1 },
        );
        let mut world = tank(heavy, heavy, 0.0, &blocks);
        world.advance(400);
        let load = world.cell_load(0);
        let force = load.flow.force + load.buoyancy.force;
        let exact = DENSITY * 0.01 * size.element_product();
        println!("{bed}: {force}, {exact}");
        assert!(
            (force - DVec3::Z * exact).length() < 1e-2 * exact,
            "{force}"
        );
    }
}

/// A dam with a gate on the downstream half of its crest, between two levels whose pressures differ by `high` (Pa).
pub fn dam(high: f64) -> String {
    format!(
        r#"{}{}
        [boundaries]
        x_min = {{ kind = "wall" }}
        x_max = {{ kind = "wall" }}
        y_min = {{ kind = "free_slip" }}
        y_max = {{ kind = "free_slip" }}
        z_min = {{ kind = "wall" }}
        z_max = {{ kind = "wall" }}
        [initial]
        pressure = "{high}*max(0, sign(6 - x))"
        [rock]
        gravity = [0, 0, 0]
        {SAFETY}
        [[blocks]]
        name = "stone"
        kind = "box"
        size = [4, 2, 3]
        position = [6, 1, 1.5]
        motion = "fixed"
        [[blocks]]
        name = "gate"
        kind = "box"
        size = [2, 2, 3]
        position = [7, 1, 4.5]
        motion = "fixed""#,
        fluid([24, 4, 12], 0.1),
        material("rock", 2650.0),
    )
}

/// The pressure in each joint is linear between its own ends and independent of other wet faces.
#[test]
fn each_joint_has_the_pressure_of_its_own_rim() {
    let high = 100.0;
    let mut world = World::new(&dam(high));
    // By then water has seeped from one side to the other.
    world.advance(200);
    let coupled = world.sim.coupled().unwrap();
    let (faces, joints) = (coupled.face_loads(0), coupled.joint_loads(0));
    let face = |normal: DVec3| {
        let mut all = faces.iter().zip(&joints);
        all.find(|(load, _)| load.face.normal.dot(normal) > 0.9)
            .unwrap()
    };
    let level = |normal: DVec3| -face(normal).0.force.dot(normal) / face(normal).0.wetted;
    let [up, down] = [level(-DVec3::X), level(DVec3::X)];
    assert!(up - down > 0.4 * high, "{up} {down}");
    let mean = 0.5 * (up + down);
    // The rim of the joint on the crest is the wet part of the crest.
    for (normal, mean) in [
        (-DVec3::Z, mean),
        (DVec3::Z, 0.5 * (level(DVec3::Z) + down)),
    ] {
        let joint = face(normal).1;
        let found = -joint.force.dot(normal) / joint.area;
        println!("{normal}: {found}, {up} to {down}");
        assert!(
            (found - mean).abs() < 0.03 * (up - down),
            "{normal}: {found}, {mean}"
        );
    }
    // ∫ p x dx about the middle of the base, with p linear from one side to the other.
    let base = face(-DVec3::Z).1;
    let arm = base.moment.y / base.force.z;
    let exact = (up - down) / (3.0 * mean);
    assert_relative(arm, exact, 0.03);
}

/// A block in open water has no joints.
#[test]
fn a_block_without_closed_joints_has_none() {
    let text = format!(
        r#"{}{}
        {SAFETY}
        [[blocks]]
        name = "stone"
        kind = "box"
        size = [2, 2, 2]
        position = [6, 6, 6]
        motion = "fixed""#,
        fluid([24; 3], 0.1),
        material("rock", 2650.0)
    );
    let mut world = World::new(&text);
    world.advance(2);
    let coupled = world.sim.coupled().unwrap();
    assert_eq!(coupled.face_loads(0).len(), 6);
    assert_eq!(coupled.wrench_with_uplift(0), None);
}
