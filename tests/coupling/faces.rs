//! Loads on the faces of blocks.

use crate::fixture::{DENSITY, WALLS, World, accelerated_fluid, fluid, material, resting};
use glam::DVec3;
use kit::{assert_near, assert_relative};
use riprap::psm::FaceLoad;

const GRAVITY: f64 = 0.01;

/// A closed tank of 24 cells (12 m) along an edge with heavy water at rest and a fixed box of 8 × 6 × 5 m.
fn tank(position: [f64; 3], angle: f64) -> World {
    let shape = "kind = \"box\"\nsize = [8, 6, 5]";
    tank_of(24, shape, position, angle, "")
}

/// The same tank with `cells` cells along an edge, a fixed block of the given shape, and `more` bodies.
fn tank_of(cells: u32, shape: &str, position: [f64; 3], angle: f64, more: &str) -> World {
    let depth = 0.5 * f64::from(cells);
    World::new(&format!(
        r#"{}{}
        {WALLS}
        [initial]
        pressure = "{DENSITY} * {GRAVITY} * ({depth} - z)"
        [rock]
        gravity = [0, 0, -{GRAVITY}]
        [numerics]
        time_step = 0.25
        velocity_scale = 0.1
        [[probes]]
        name = "load"
        kind = "block"
        block = "stone"
        faces = true
        [[blocks]]
        name = "stone"
        {shape}
        position = {position:?}
        rotation = {{ axis = [1, 2, 3], angle = {angle} }}
        motion = "fixed"
        {more}"#,
        accelerated_fluid([cells; 3], 0.1, [0.0, 0.0, -GRAVITY]),
        material("rock", 2650.0)
    ))
}

fn faces(world: &World) -> &[FaceLoad] {
    world.sim.coupled().unwrap().face_loads(0)
}

/// Pressure is linear in still water, so that its mean over a face equals the pressure at the centroid, up to rounding for
/// faces along the grid. On other faces, the cells next to the face are off-centre by less than a tenth of a cell. The slope
/// through them corrects for this, up to the variance of a cell, 1/12, relative to that of ten cells. The sum over the faces
/// is the whole load with the same error; its moment also contains the spread of the cells times a tenth of a cell.
#[test]
fn still_water_presses_by_its_depth() {
    for (position, angle, limit) in [([6.0, 6.0, 6.0], 0.0, 1e-5), ([6.1, 5.9, 6.3], 25.0, 1e-3)] {
        let mut world = tank(position, angle);
        assert!(faces(&world).is_empty(), "before the first exchange");
        world.advance(200);
        let (mut force, mut moment) = (DVec3::ZERO, DVec3::ZERO);
        let head = DENSITY * GRAVITY * 5.0;
        for load in faces(&world) {
            let there = DENSITY * GRAVITY * (12.0 - load.face.centre.z);
            let error = (load.pressure() - there) / head;
            println!("{}: {error:.1e}, {} cells", load.face.normal, load.cells);
            assert_eq!(load.wetted, load.face.area);
            assert!(error.abs() < limit, "{}: {error}", load.face.normal);
            assert!(load.shear().length() < 1e-6 * head);
            force += load.force;
            moment += load.moment;
        }
        let load = world.cell_load(0);
        let whole = load.flow.force + load.buoyancy.force;
        let exact = DENSITY * GRAVITY * 240.0;
        let error = (force - whole) / exact;
        println!("sum {error}; moment {}", moment / (exact * 8.0));
        assert!(error.length() < 2.0 * limit, "{error}");
        // The moment about the centroid vanishes.
        assert!(moment.length() < 10.0 * limit * exact * 8.0, "{moment}");
    }
}

/// Parts of one block that meet in a seam, rotated off the grid: cells that the other part cuts are not used for a face, and
/// the seam is not a face. The faces together have the buoyancy through the centroid, and each has the pressure at its depth,
/// within the resolution of 5 to 12 cells in rows that begin up to two cells from the edge of a seam.
#[test]
fn compounds_in_still_water_feel_archimedes_push_on_their_faces() {
    let part = |size: [f64; 3], offset: [f64; 3]| {
        format!("{{ kind = \"box\", size = {size:?}, position = {offset:?} }}")
    };
    let base = part([6.0, 4.0, 2.5], [0.0; 3]);
    let corner = part([2.5, 4.0, 4.0], [-1.75, 0.0, 3.25]);
    let middle = part([2.5, 3.0, 4.0], [0.25, 0.25, 3.25]);
    let degrees = 0.3_f64.to_degrees();
    for (name, on_top, volume, seam) in [("L", corner, 100.0, 10.0), ("T", middle, 90.0, 7.5)] {
        let shape = format!("kind = \"compound\"\nparts = [{base}, {on_top}]");
        for angle in [0.0, degrees] {
            let mut world = tank_of(24, &shape, [6.3, 6.0, 5.0], angle, "");
            world.advance(100);
            let push = DENSITY * GRAVITY * volume;
            let (mut force, mut moment, mut wet) = (DVec3::ZERO, DVec3::ZERO, 0.0);
            let mut covered = 0;
            for load in faces(&world) {
                force += load.force;
                moment += load.moment;
                wet += load.wetted;
                let dry = load.face.area - load.wetted;
                if dry > 1e-9 {
                    assert!((dry - seam).abs() < 1e-9, "{name} {angle}: {load:?}");
                    covered += 1;
                }
                if load.wetted > 0.0 {
                    let there = DENSITY * GRAVITY * (12.0 - load.centre.z);
                    let error = (load.pressure() - there) / (DENSITY * GRAVITY * 6.5);
                    println!("{}: {error:.1e}, {} cells", load.face.normal, load.cells);
                    assert!(error.abs() < 3e-3, "{name} {angle}: {load:?}");
                } else {
                    assert_eq!(load.force, DVec3::ZERO, "inside a seam");
                }
            }
            assert_eq!(covered, 2, "both sides of the seam");
            let load = world.cell_load(0);
            let whole = load.flow.force + load.buoyancy.force;
            let [off, apart] = [force - DVec3::Z * push, force - whole].map(|f| f.length() / push);
            let turn = moment.length() / (push * 6.5);
            println!("{name} {angle:.0}: {off:.1e} {apart:.1e}, moment {turn:.1e}, {wet} m²");
            assert!(off < 3e-3, "{name} {angle}: {force} N, not {push}");
            assert!(apart < 3e-3, "{name} {angle}: {force} N, not {whole}");
            assert!(turn < 2e-2, "{name} {angle}: {moment} N m");
        }
    }
}

/// A box that moves four cells along x, through two tile searches: its faces always have all of their adjacent cells.
#[test]
fn faces_of_a_block_in_motion_see_all_cells_beside_them() {
    let text = format!(
        r#"{}{}
        [numerics]
        time_step = 0.25
        velocity_scale = 0.2
        [[probes]]
        name = "load"
        kind = "block"
        block = "stone"
        faces = true
        [[blocks]]
        name = "ball"
        kind = "sphere"
        radius = 1
        position = [10, 10, 10]
        motion = "fixed"
        [[blocks]]
        name = "stone"
        kind = "box"
        size = [4, 3, 2.5]
        position = [3, 3, 3.25]
        motion = "driven"
        velocity = [0.2, 0, 0]"#,
        fluid([24; 3], 0.1),
        material("rock", 2650.0)
    );
    let mut world = World::new(&text);
    for step in 1..=40 {
        world.advance(1);
        let coupled = world.sim.coupled().unwrap();
        assert!(
            coupled.face_loads(0).is_empty(),
            "nobody asks about the ball"
        );
        assert_eq!(coupled.face_loads(1).len(), 6);
        for load in coupled.face_loads(1) {
            // 8 × 6 × 5 cells, and one more along x if both ends lie on cell centres.
            let area = 4.0 * load.face.area;
            let cells = f64::from(load.cells);
            let most = if load.face.normal.x.abs() > 0.5 {
                area
            } else {
                area * 9.0 / 8.0
            };
            assert!(
                (area..=most).contains(&cells),
                "step {step}: {cells} of {area}"
            );
        }
    }
    let searches = world.sim.coupled().unwrap().exchanges().cells.searches;
    assert!(searches > 2, "{searches}");
}

/// If the block stands on the bottom, its base is dry, and the other faces are unchanged.
#[test]
fn a_face_on_the_ground_is_dry() {
    let mut world = tank([6.0, 6.0, 2.5], 0.0);
    world.advance(200);
    for load in faces(&world) {
        if load.face.normal.z < -0.5 {
            assert_eq!((load.wetted, load.cells), (0.0, 0));
            assert!(load.pressure().is_nan());
            assert_eq!(load.force, DVec3::ZERO);
        } else {
            let there = DENSITY * GRAVITY * (12.0 - load.face.centre.z);
            assert_relative(load.pressure(), there, 1e-5);
        }
    }
}

/// The surface of a bed lies inside a cell, a fifth above its bottom: the cells in front of the sides of a block on it are wet, and
/// the sides have the pressure of still water at their depth.
#[test]
fn sides_of_a_block_on_a_bed_inside_a_cell_are_wet() {
    let solid = r#"[[solids]]
        kind = "box"
        min = [-1, -1, -1]
        max = [13, 13, 1.1]
        surface = "exact""#;
    let block = r#"[[blocks]]
        kind = "box"
        size = [12, 12, 1.1]
        position = [6, 6, 0.55]
        motion = "fixed""#;
    let shape = "kind = \"box\"\nsize = [8, 6, 5]";
    for bed in [solid, block] {
        let mut world = tank_of(24, shape, [6.0, 6.0, 3.6], 0.0, bed);
        world.advance(200);
        let sides = faces(&world)
            .iter()
            .filter(|load| load.face.normal.z > -0.5);
        for load in sides {
            let there = DENSITY * GRAVITY * (12.0 - load.face.centre.z);
            let error = load.pressure() / there - 1.0;
            println!("{}: {error:.1e}", load.face.normal);
            assert_eq!(load.wetted, load.face.area);
            assert!(error.abs() < 1e-3, "{}: {error}", load.face.normal);
        }
    }
}

/// Couette flow over a slab as wide as the periodic domain: τ = μU/H everywhere on its top. The slab's surface moves due to τ
/// by less than a hundredth of H = 8 cells.
#[test]
fn a_moving_lid_shears_the_face_below() {
    let (speed, nu) = (0.1, 0.1);
    let mut world = World::new(&format!(
        r#"{}{}
        [boundaries]
        z_min = {{ kind = "wall" }}
        z_max = {{ kind = "wall", velocity = [{speed}, 0, 0] }}
        [initial]
        velocity = ["{speed} * max(0, z - 2)/4", 0, 0]
        [rock]
        gravity = [0, 0, 0]
        [numerics]
        time_step = 0.25
        velocity_scale = 0.2
        [[probes]]
        name = "load"
        kind = "block"
        block = "slab"
        faces = true
        [[blocks]]
        name = "slab"
        kind = "box"
        size = [4, 4, 2]
        position = [2, 2, 1]
        motion = "fixed""#,
        fluid([8, 8, 12], nu),
        material("rock", 2650.0)
    ));
    world.advance(400);
    let exact = DENSITY * nu * speed / 4.0;
    let top = faces(&world).iter().find(|load| load.face.normal.z > 0.5);
    let top = top.unwrap();
    let load = world.cell_load(0).flow.force;
    println!("{} of {exact}, {load}", top.shear());
    assert!((top.shear() - DVec3::X * exact).length() < 1e-2 * exact);
    // The sum over the cells of the slab yields the same force.
    assert_relative(top.force.x, load.x, 1e-2);
}

/// Flow through a periodic array of cubes, 8 cells wide, at Re ≈ 4: the faces together have the drag of the cube, up to what the
/// resolution of the edges leaves.
#[test]
fn faces_in_a_flow_have_the_drag_of_their_block() {
    let acceleration = 4e-3;
    let mut world = World::new(&format!(
        r#"{}{}
        [rock]
        gravity = [0, 0, 0]
        [numerics]
        time_step = 0.25
        velocity_scale = 0.2
        [[probes]]
        name = "load"
        kind = "block"
        block = "cube"
        faces = true
        [[blocks]]
        name = "cube"
        kind = "box"
        size = [4, 4, 4]
        position = [5, 5, 5]
        motion = "fixed""#,
        accelerated_fluid([24, 20, 20], 0.1, [acceleration, 0.0, 0.0]),
        material("rock", 2650.0)
    ));
    world.advance(1500);
    let force: DVec3 = faces(&world).iter().map(|load| load.force).sum();
    // Less the mean pressure gradient, which is no traction in the cells.
    let drag = world.cell_load(0).flow.force.x - DENSITY * acceleration * 64.0;
    println!("{force}, {drag}");
    assert_relative(force.x, drag, 5e-2);
}

#[test]
fn loads_on_faces_repeat_to_the_bit() {
    let run = || {
        let mut world = tank([6.1, 5.9, 6.3], 25.0);
        world.advance(20);
        faces(&world).to_vec()
    };
    assert_eq!(run(), run());
}

#[test]
fn who_does_not_ask_has_no_loads_on_faces() {
    let text = format!(
        r#"{}{}
        [numerics]
        time_step = 0.25
        velocity_scale = 0.1
        [[blocks]]
        kind = "box"
        size = [2, 2, 2]
        position = [3, 3, 3]"#,
        fluid([12; 3], 0.1),
        material("rock", 2650.0)
    );
    let world = World::new(&text);
    let immersed = world.sim.coupled().unwrap().solid_cells();
    assert!(immersed.face_sums().is_none());
    assert!(
        immersed
            .kernels()
            .all(|(kernel, _)| !kernel.entry().contains("faces"))
    );
}

/// A bar across a channel that is periodic along z, with flow along x; it has the length `length` along z and its middle at
/// `z`.
fn bar(length: f64, z: f64) -> World {
    turned_bar(length, z, 0.0)
}

/// The same bar, rotated by `angle` degrees about its axis.
fn turned_bar(length: f64, z: f64, angle: f64) -> World {
    let mut world = World::new(&format!(
        r#"{}{}
        [boundaries]
        y_min = {{ kind = "wall" }}
        y_max = {{ kind = "wall" }}
        [initial]
        velocity = [0.05, 0, 0]
        [rock]
        gravity = [0, 0, 0]
        [numerics]
        time_step = 0.25
        velocity_scale = 0.2
        [[probes]]
        name = "load"
        kind = "block"
        block = "bar"
        faces = true
        [[blocks]]
        name = "bar"
        kind = "box"
        size = [5, 5, {length}]
        position = [10, 6, {z}]
        rotation = {{ axis = [0, 0, 1], angle = {angle} }}
        motion = "fixed""#,
        fluid([40, 24, 8], 0.1),
        material("rock", 2650.0)
    ));
    world.advance(200);
    world
}

/// The load on a face is per period, like the load on the block, to within some per cent of the drag of ten cells.
#[test]
fn faces_longer_than_a_period_feel_one_period() {
    for (length, z) in [(4.0, 2.0), (14.0, 1.3), (22.0, 2.0)] {
        let world = bar(length, z);
        let load = world.cell_load(0).flow.force.x;
        let sum: f64 = faces(&world).iter().map(|load| load.force.x).sum();
        println!("{length}: {sum} {load}");
        assert!((sum / load - 1.0).abs() < 0.1, "{length}: {sum}, {load} N");
        for load in faces(&world) {
            let normal = load.face.normal;
            let one = if normal.z.abs() > 0.5 { 0.0 } else { 20.0 };
            assert!((load.wetted - one).abs() < 1e-9, "{normal}: {load:?}");
        }
    }
}

/// The solid fraction of cells that its faces cut does not increase if the bar extends beyond the domain.
#[test]
fn what_is_longer_than_a_period_is_there_once() {
    let feels = |length, z| turned_bar(length, z, 20.0).cell_load(0);
    let (short, long) = (feels(4.0, 2.0), feels(14.0, 1.3));
    println!("{short:?} {long:?}");
    let apart = (short.flow.force - long.flow.force).length();
    assert!(apart < 1e-5 * short.flow.force.length(), "{apart} N");
}

/// A block on both sides of a periodic face has complete faces.
#[test]
fn faces_across_a_periodic_face_are_whole() {
    let loads = |z: f64| {
        let world = bar(2.0, z);
        faces(&world).to_vec()
    };
    for (inside, across) in loads(2.0).iter().zip(&loads(4.0)) {
        assert_eq!(across.wetted, across.face.area);
        let difference = (inside.force - across.force).length();
        assert!(
            difference < 1e-4 * inside.face.area,
            "{inside:?} {across:?}"
        );
    }
}

/// The parts of faces outside of the domain are ignored.
#[test]
fn faces_end_at_the_walls() {
    let mut world = tank([6.0, 6.0, 1.0], 0.0);
    world.advance(20);
    for load in faces(&world) {
        let exact = match load.face.normal {
            n if n.z > 0.5 => 48.0,
            n if n.z < -0.5 => 0.0,
            n if n.x.abs() > 0.5 => 6.0 * 3.5,
            _ => 8.0 * 3.5,
        };
        assert_near(load.wetted, exact, 1e-9);
    }
}

/// The loads on faces are those of the last exchange, however many steps an advance takes: while a block is awake, when it
/// falls asleep, and between two exchanges of a sleeping one.
#[test]
fn long_advances_end_with_the_face_loads_of_single_steps() {
    let text = resting(
        r#"[[probes]]
        name = "load"
        kind = "block"
        block = "stone"
        faces = true"#,
    );
    let mut single = World::new(&text);
    let mut slept = None;
    for step in 1..=60 {
        single.advance(1);
        let mut asleep = single.sim.coupled().unwrap().blocks().asleep();
        if asleep.any(|asleep| asleep) {
            slept.get_or_insert(step);
        }
        let compared = slept.map_or(step == 3, |first| step - first < 3 || step % 16 < 2);
        if compared {
            let mut long = World::new(&text);
            long.advance(step);
            assert!(faces(&long) == faces(&single), "after {step} steps");
        }
    }
    assert!(slept.is_some_and(|first| first > 3), "{slept:?}");
}
