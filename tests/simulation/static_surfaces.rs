//! Static solids at the exact position of their surface, next to blocks; blocks on terrain.

use crate::probed_at_end;
use glam::DVec3;
use kit::{Rig, assert_near};
use riprap::{
    scene::{Face, Scene},
    simulation::{WallFriction, WallPlace},
};
use std::{fs, path::PathBuf};

/// Flow through a periodic channel over a bed 0.24 m high and past a block just above it, so that both share cells.
fn over_bed(bed: &str) -> Scene {
    kit::scene::read(&format!(
        r#"
        domain = {{ size = [2.4, 1.2, 1.2], cell = 0.1 }}
        fluid = {{ viscosity = 0.05, density = 1000, acceleration = [0.05, 0, 0] }}
        numerics.time_step = 0.02
        run.steps = 1200
        boundaries = {{ z_min = {{ kind = "wall" }}, z_max = {{ kind = "wall" }} }}
        [[materials]]
        name = "rock"
        density = 2650
        normal_stiffness = 1e6
        friction = 30
        [[blocks]]
        name = "hovers"
        kind = "box"
        size = [0.6, 0.5, 0.4]
        position = [1.0, 0.6, 0.47]
        motion = "driven"
        velocity = [0, 0, 0]
        {bed}
        "#
    ))
    .unwrap()
}

#[test]
fn a_block_above_a_static_bed_bears_what_it_bears_above_a_block() {
    let rig = Rig::new();
    let load = |bed: &str| {
        let mut simulation = rig.simulation(&over_bed(bed)).unwrap();
        rig.wait(simulation.advance(1200)).unwrap();
        simulation.coupled().unwrap().external_load()[0].flow
    };
    let block = load(
        "[[blocks]]\nname = \"bed\"\nkind = \"box\"\nsize = [4.8, 4.8, 1]\nposition = [1.2, 0.6, -0.26]\nmotion = \"fixed\"",
    );
    let solid = load(
        "[[solids]]\nkind = \"box\"\nmin = [-9, -9, -1]\nmax = [9, 9, 0.24]\nsurface = \"exact\"",
    );
    assert!(block.force.x > 0.0);
    assert_near(solid.force.x / block.force.x, 1.0, 0.01);
    assert_near(solid.torque().y / block.torque().y, 1.0, 0.03);
}

/// The cells that a rough bed cuts take their momentum from the flow above: the stress does not drive them backwards.
#[test]
fn a_bed_nearly_along_the_grid_slows_the_whole_stream() {
    let rig = Rig::new();
    for slope in [0.0, 0.05] {
        let scene = kit::scene::read(&format!(
            r#"
            domain = {{ size = [0.16, 0.16, 0.26], cell = 0.02 }}
            fluid = {{ viscosity = 1e-6, acceleration = [0.02, 0, 0] }}
            numerics = {{ eddy_viscosity = "wale", wall_model = "werner_wengle", velocity_scale = 1.3, mach = 0.08 }}
            initial.velocity = ["0.154 * log(1 + 15000 * max(0, z - 0.07))", 0, 0]
            run.duration = 3
            [boundaries]
            y_min = {{ kind = "free_slip" }}
            y_max = {{ kind = "free_slip" }}
            z_min = {{ kind = "wall" }}
            z_max = {{ kind = "free_slip" }}
            [[solids]]
            kind = "half_space"
            point = [0, 0.08, 0.07]
            normal = [0, {slope}, 1]
            surface = "exact"
            roughness = 0.002
            [[probes]]
            name = "cut"
            kind = "box"
            min = [0, 0, 0.06]
            max = [0.16, 0.16, 0.08]
            fields = ["velocity"]
            "#
        ))
        .unwrap();
        let least = probed_at_end(&rig, &scene)["velocity_x_min"];
        assert!(least > -0.05, "slope {slope}: {least}");
    }
}

/// The links at the edge between a velocity face and solids belong to the face.
#[test]
fn an_inlet_between_solids_has_its_flow() {
    let rig = Rig::new();
    let solid = |sides: &str| format!("[[solids]]\nkind = \"box\"\n{sides}\n");
    let scene = kit::scene::read(&format!(
        r#"
        domain = {{ size = [0.16, 0.14, 0.12], cell = 0.02 }}
        fluid.viscosity = 5e-3
        numerics = {{ velocity_scale = 1.1, mach = 0.05 }}
        run.duration = 1
        [boundaries]
        x_min = {{ kind = "velocity", velocity = [0.5, 0, 0] }}
        x_max = {{ kind = "pressure" }}
        y_min = {{ kind = "wall" }}
        y_max = {{ kind = "wall" }}
        z_min = {{ kind = "free_slip" }}
        z_max = {{ kind = "wall" }}
        [[probes]]
        name = "across"
        kind = "box"
        min = [0.06, 0, 0]
        max = [0.08, 0.14, 0.12]
        fields = ["velocity"]
        {}{}{}
        "#,
        solid("min = [-1, -1, -1]\nmax = [1, 0.02, 1]"),
        solid("min = [-1, 0.12, -1]\nmax = [1, 1, 1]"),
        solid("min = [-1, -1, 0.1]\nmax = [1, 1, 1]"),
    ))
    .unwrap();
    let mean = probed_at_end(&rig, &scene)["velocity_x_mean"];
    assert_near(mean / 0.5, 1.0, 0.01);
}

/// Over the edges between the triangles of a terrain as over a single plane: v = g (sin 30° − tan 20° cos 30°) t.
#[test]
fn a_block_slides_over_terrain_as_over_a_plane() {
    let dir = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("slides_over_terrain");
    fs::create_dir_all(&dir).unwrap();
    let mut survey = String::new();
    for (i, j) in (0..20).flat_map(|j| (0..30).map(move |i| (i, j))) {
        // Too little to affect the block, and enough that no two triangles are coplanar.
        let height = 1e-6 * f64::from((7 * i + 3 * j) % 5);
        survey += &format!("{} {} {height:e}\n", 0.1 * f64::from(i), 0.1 * f64::from(j));
    }
    fs::write(dir.join("bed.xyz"), survey).unwrap();
    let scene = r#"
        rock.gravity = [4.905, 0, -8.4957]
        run.duration = 0.6
        [[materials]]
        name = "rock"
        density = 2600
        normal_stiffness = 1e8
        friction = 20
        [[solids]]
        kind = "terrain"
        file = "bed.xyz"
        [[blocks]]
        kind = "box"
        size = [0.33, 0.27, 0.2]
        position = [0.5, 1.0, 0.1]
        "#;
    let scene = Scene::from_toml(scene, &dir, "slide.toml").unwrap();
    let rig = Rig::new();
    let mut simulation = rig.simulation(&scene).unwrap();
    rig.wait(simulation.advance(1000)).unwrap();
    let pose = simulation.rock().unwrap().poses()[0];
    let expected = (4.905 - 20f64.to_radians().tan() * 8.4957) * simulation.time();
    assert!(expected > 0.5);
    assert_near(pose.velocity.x, expected, 0.005 * expected);
    assert!(pose.deformation_rate.abs_diff_eq(glam::DMat3::ZERO, 1e-3));
}

/// Terrain of small triangles holds water as a box does, and no block fits below its surface.
#[test]
fn terrain_is_solid_down_to_the_domain() {
    let dir = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("solid_terrain");
    fs::create_dir_all(&dir).unwrap();
    let nodes =
        (0..9).flat_map(|j| (0..9).map(move |i| [i, j].map(|i| 0.05 * f64::from(i) - 0.05)));
    let survey: String = nodes.map(|[x, y]| format!("{x} {y} 0.2\n")).collect();
    fs::write(dir.join("floor.xyz"), survey).unwrap();
    let rig = Rig::new();
    let read = |floor: &str, more: &str| {
        let keys = format!(
            r#"
            domain = {{ size = [0.3, 0.3, 0.45] }}
            fluid.acceleration = [0, 0, -9.81]
            particles.spacing = 0.025
            run.duration = 0.05
            boundaries = {{ x_min = {{ kind = "wall" }}, x_max = {{ kind = "wall" }}, y_min = {{ kind = "wall" }}, y_max = {{ kind = "wall" }}, z_min = {{ kind = "wall" }}, z_max = {{ kind = "open" }} }}
            [[materials]]
            name = "rock"
            density = 2600
            normal_stiffness = 1e7
            friction = 30
            [[water]]
            kind = "box"
            size = [0.3, 0.3, 0.35]
            position = [0.15, 0.15, 0.175]
            [[solids]]
            {floor}
            {more}
            "#
        );
        Scene::from_toml(&keys, &dir, "terrain.toml").unwrap()
    };
    let terrain = "kind = \"terrain\"\nfile = \"floor.xyz\"";
    let still = |floor: &str| {
        let scene = read(floor, "");
        let mut simulation = rig.simulation(&scene).unwrap();
        let steps = scene.run.count(simulation.time_step());
        rig.wait(simulation.advance(steps)).unwrap();
        rig.wait(simulation.water()).unwrap()
    };
    let solid = "kind = \"box\"\nmin = [-0.1, -0.1, -0.2]\nmax = [0.4, 0.4, 0.2]";
    let [found, expected] = [terrain, solid].map(still);
    assert_eq!(found.positions.len(), expected.positions.len());
    let lowest = found.positions.iter().map(|at| at.z).fold(1.0, f64::min);
    let speeds = found.velocities.iter().map(|v| v.length());
    let fastest = speeds.fold(0.0, f32::max);
    println!("lowest at {lowest} m, up to {fastest} m/s");
    assert!(lowest > 0.2 && fastest < 0.3, "{lowest} m, {fastest} m/s");
    let below =
        "[[blocks]]\nkind = \"box\"\nsize = [0.05, 0.05, 0.05]\nposition = [0.15, 0.15, 0.04]";
    let refused = rig.simulation(&read(terrain, below)).err().unwrap();
    assert!(refused.to_string().contains("overlap"), "{refused}");
}

/// The steps of the staircase under a sloping face take in and give off fluid as it slides over them, as much at any pressure.
#[test]
fn friction_at_sloping_faces_conserves_mass() {
    let rig = Rig::new();
    for round in [
        "[[solids]]\nkind = \"sphere\"\ncenter = [1.2, 1.2, 0.9]\nradius = 0.55\nsurface = \"exact\"",
        "[[materials]]\nname = \"rock\"\ndensity = 2650\nnormal_stiffness = 1e6\nfriction = 30\n\
         [[blocks]]\nkind = \"box\"\nsize = [1.1, 1.1, 1.1]\nposition = [1.2, 1.2, 0.9]\nmotion = \"fixed\"\n\
         rotation = { axis = [0, 0, 1], angle = 26.565 }",
    ] {
        let scene = kit::scene::read(&format!(
            r#"
            domain = {{ size = [2.4, 2.4, 1.8], cell = 0.05 }}
            fluid = {{ viscosity = 1e-5 }}
            numerics = {{ velocity_scale = 1, eddy_viscosity = "wale", wall_model = "reichardt" }}
            initial = {{ velocity = [0.3, 0.1, 0.6], pressure = "5000" }}
            run.steps = 60
            {round}
            "#
        ));
        let mut simulation = rig.simulation(&scene.unwrap()).unwrap();
        let before = rig.wait(simulation.totals()).unwrap().mass;
        rig.wait(simulation.advance(60)).unwrap();
        let after = rig.wait(simulation.totals()).unwrap().mass;
        assert_near(after / before, 1.0, 1e-6);
    }
}

/// A stream at a wall model past one block, between walls of the domain or faces of other kinds: keys of the scene and of the block.
fn past_block(domain: &str, block: &str) -> Scene {
    kit::scene::read(&format!(
        r#"
        fluid = {{ viscosity = 1e-6 }}
        numerics = {{ velocity_scale = 1.4, mach = 0.06, eddy_viscosity = "wale", wall_model = "werner_wengle" }}
        run.steps = 120
        {domain}
        [[materials]]
        name = "rock"
        density = 2650
        normal_stiffness = 1e6
        friction = 30
        [[blocks]]
        kind = "box"
        {block}
        "#
    ))
    .unwrap()
}

/// The mean force along x on the block of a scene over steps 60 to 120, N.
fn friction_on_block(rig: &Rig, scene: &Scene) -> f64 {
    let mut simulation = rig.simulation(scene).unwrap();
    rig.wait(simulation.advance(60)).unwrap();
    let forces = (0..60).map(|_| {
        rig.wait(simulation.advance(1)).unwrap();
        let loads = simulation.coupled().unwrap().external_load();
        loads[0].flow.force.x
    });
    forces.sum::<f64>() / 60.0
}

/// Across the steps of the full cells, too, a slope has the friction of the law: the pressure on single steps cancels.
#[test]
fn a_stream_along_a_slope_has_the_friction_of_the_law() {
    let rig = Rig::new();
    let (cell, height) = (0.05, 1.0);
    for (run, limit) in [(1.0, 0.05), (2.0, 0.3), (3.0, 0.4), (5.0, 0.4), (8.0, 0.5)] {
        let along = DVec3::new(run, 0.0, 1.0).normalize();
        // Slabs through the corners of the period; the others are their images.
        let block = |n: usize| {
            format!(
                "size = [{}, 2, 0.3]\nposition = [{}, {}, {}]\nmotion = \"fixed\"\n\
                 rotation = {{ axis = [0, 1, 0], angle = {} }}\n",
                6.0 * run.hypot(height),
                0.5 * run * height,
                0.5 * cell,
                (n as f64 - 1.5) * height,
                -(1.0 / run).atan().to_degrees(),
            )
        };
        let blocks: Vec<String> = (0..5).map(block).collect();
        let domain = format!(
            "domain = {{ size = [{}, {cell}, {height}], cell = {cell} }}\ninitial = {{ velocity = {:?} }}",
            run * height,
            along.to_array()
        );
        let scene = past_block(&domain, &blocks.join("[[blocks]]\nkind = \"box\"\n"));
        let mut simulation = rig.simulation(&scene).unwrap();
        let mut momentum = |steps: u64| {
            rig.wait(simulation.advance(steps)).unwrap();
            let totals = rig.wait(simulation.totals()).unwrap();
            (simulation.time(), DVec3::from(totals.momentum).dot(along))
        };
        let [(start, before), (end, after)] = [400, 600].map(&mut momentum);
        let force = (before - after) / (end - start);
        let frictions = rig.wait(simulation.wall_friction()).unwrap();
        let walls = frictions.walls.iter();
        let by_law: f64 = walls
            .map(|wall| wall.area * DVec3::from(wall.stress).dot(along))
            .sum();
        println!("1 : {run}: {force} N, {by_law} N by the law");
        assert_near(force / by_law, 1.0, limit);
    }
}

/// Next to a cell that is almost full the model acts as elsewhere.
#[test]
fn an_exact_slope_that_almost_fills_cells_keeps_the_model() {
    let rig = Rig::new();
    let friction = |below_corner: f64| {
        let keys = format!(
            r#"
            domain = {{ size = [0.8, 0.1, 1.6], cell = 0.05 }}
            fluid.viscosity = 1e-6
            numerics = {{ velocity_scale = 1.4, mach = 0.06, eddy_viscosity = "wale", wall_model = "werner_wengle" }}
            initial.velocity = [0, 1, 0]
            run.steps = 400
            boundaries = {{ x_min = {{ kind = "free_slip" }}, x_max = {{ kind = "free_slip" }}, z_min = {{ kind = "wall" }}, z_max = {{ kind = "free_slip" }} }}
            [[solids]]
            kind = "half_space"
            point = [0, 0, {}]
            normal = [-1, 0, 2]
            surface = "exact"
            "#,
            0.2 - 0.05 * below_corner
        );
        let mut simulation = rig.simulation(&kit::scene::read(&keys).unwrap()).unwrap();
        let mut momentum = |steps: u64| {
            rig.wait(simulation.advance(steps)).unwrap();
            rig.wait(simulation.totals()).unwrap().momentum[1]
        };
        let [before, after] = [200, 200].map(&mut momentum);
        before - after
    };
    // A cell that the plane cuts at a corner lacks the square of this depth in cells.
    let [usual, almost_full] = [0.2, 0.014].map(friction);
    println!("{usual} and {almost_full} N s");
    assert!(usual > 0.0);
    assert_near(almost_full / usual, 1.0, 0.1);
}

/// Noise in full cells that move brings fluid to the edges, which have no slip: oblique rods in motion have more friction.
#[test]
fn a_rod_in_motion_has_the_friction_of_one_at_rest_in_a_stream() {
    let rig = Rig::new();
    for (angle, limit) in [(0.0, 0.05), (26.565, 0.5), (45.0, 0.5)] {
        let friction = |stream: f64| {
            let domain = format!(
                r#"
                domain = {{ size = [0.2, 1.6, 1.6], cell = 0.05 }}
                initial = {{ velocity = [{stream}, 0, 0] }}
                boundaries.y_min = {{ kind = "free_slip" }}
                boundaries.y_max = {{ kind = "free_slip" }}
                boundaries.z_min = {{ kind = "free_slip" }}
                boundaries.z_max = {{ kind = "free_slip" }}
                "#
            );
            let rod = format!(
                "size = [0.2, 0.6, 0.6]\nposition = [0.1, 0.813, 0.807]\nmotion = \"driven\"\n\
                 rotation = {{ axis = [1, 0, 0], angle = {angle} }}\nvelocity = [{}, 0, 0]",
                stream - 1.0
            );
            friction_on_block(&rig, &past_block(&domain, &rod))
        };
        let (at_rest, moves) = (friction(1.0), friction(0.0));
        println!("{angle}: {at_rest} N at rest, {moves} N in motion");
        assert!(at_rest > 0.0);
        assert_near(moves / at_rest, 1.0, limit);
    }
}

/// Keys of a domain with a bed, where the water flows along x.
fn bed_between(sides: &str, size: [f64; 3]) -> String {
    format!(
        r#"
        domain = {{ size = {size:?}, cell = 0.05 }}
        initial = {{ velocity = [1, 0, 0] }}
        boundaries.y_min = {{ kind = "{sides}" }}
        boundaries.y_max = {{ kind = "{sides}" }}
        boundaries.z_min = {{ kind = "wall" }}
        boundaries.z_max = {{ kind = "free_slip" }}
        "#
    )
}

/// Between free-slip faces a bed has the friction of the middle of a wide one, over its whole width.
#[test]
fn free_slip_faces_continue_a_bed() {
    let rig = Rig::new();
    let friction = |sides: &str, width: f64| {
        let bed = format!(
            "size = [0.4, {width}, 0.8]\nposition = [0.2, 0.1, 0.02]\nmotion = \"driven\"\nvelocity = [0, 0, 0]"
        );
        let scene = past_block(&bed_between(sides, [0.4, 0.2, 1.2]), &bed);
        friction_on_block(&rig, &scene)
    };
    let [closed, periodic] = [("free_slip", 0.3), ("periodic", 0.2)];
    let [closed, periodic] = [closed, periodic].map(|(sides, width)| friction(sides, width));
    assert_near(closed / periodic, 1.0, 1e-3);
}

/// The walls of the model are those without a block in the five cells in front of them.
#[test]
fn walls_under_a_block_are_not_counted_as_walls_with_the_model() {
    let rig = Rig::new();
    let block = "size = [0.8, 0.4, 0.5]\nposition = [0.4, 0.2, 0.25]\nmotion = \"fixed\"";
    let scene = past_block(&bed_between("periodic", [1.6, 0.4, 1.2]), block);
    let mut simulation = rig.simulation(&scene).unwrap();
    rig.wait(simulation.advance(20)).unwrap();
    let frictions = rig.wait(simulation.wall_friction()).unwrap();
    let floor = |wall: &&WallFriction| wall.place == WallPlace::Face(Face::ZMin);
    let floor: Vec<_> = frictions.walls.iter().filter(floor).collect();
    assert!(!floor.is_empty());
    for wall in floor {
        // Behind the block as in front of it, across the period.
        assert!((0.8..1.6).contains(&wall.position[0]), "{wall:?}");
        assert_eq!(wall.area, 0.05 * 0.05);
    }
}

/// The law acts on the whole area of a prism, although columns of cells end before its edges.
#[test]
fn the_wall_model_acts_on_the_whole_area_of_a_turned_prism() {
    let rig = Rig::new();
    for angle in [0, 20, 30, 45] {
        let domain = "domain = { size = [2.4, 2.4, 0.3], cell = 0.05 }\ninitial = { velocity = [0, 0, 0.8] }";
        let prism = format!(
            "size = [1.2, 1.2, 0.3]\nposition = [1.215, 1.23, 0.15]\nmotion = \"fixed\"\n\
             rotation = {{ axis = [0, 0, 1], angle = {angle} }}"
        );
        let mut simulation = rig.simulation(&past_block(domain, &prism)).unwrap();
        rig.wait(simulation.advance(4)).unwrap();
        let frictions = rig.wait(simulation.wall_friction()).unwrap();
        let area: f64 = frictions.walls.iter().map(|wall| wall.area).sum();
        assert_near(area / (4.0 * 1.2 * 0.3), 1.0, 0.05);
    }
}

/// A bed that cuts cells up to a pressure face: the pressure wave of the start leaves, and the stream passes.
#[test]
fn a_stream_over_an_exact_bed_leaves_by_an_outlet() {
    let rig = Rig::new();
    let scene = kit::scene::read(
        r#"
        domain = { size = [1.6, 0.2, 0.8], cell = 0.05 }
        fluid = { viscosity = 1e-5 }
        numerics = { velocity_scale = 1, eddy_viscosity = "wale", wall_model = "reichardt" }
        run.duration = 6
        [boundaries]
        x_min = { kind = "velocity", velocity = ["0.6*min(1, max(0, z - 0.2)/0.05)", 0, 0] }
        x_max = { kind = "pressure" }
        y_min = { kind = "free_slip" }
        y_max = { kind = "free_slip" }
        z_min = { kind = "wall" }
        z_max = { kind = "free_slip" }
        [[solids]]
        kind = "box"
        min = [0, 0, 0]
        max = [1.6, 0.2, 0.22]
        surface = "exact"
        [[probes]]
        name = "outlet"
        kind = "box"
        min = [1.5, 0, 0.25]
        max = [1.6, 0.2, 0.8]
        fields = ["pressure", "velocity"]
        "#,
    )
    .unwrap();
    let found = probed_at_end(&rig, &scene);
    // A dynamic pressure is 180 Pa.
    assert_near(found["pressure_mean"], 0.0, 180.0);
    assert_near(found["velocity_x_mean"], 0.58, 0.03);
}
