//! Scenes of particles: their keys, and keys that they do not combine with.

use riprap::rock::{Blocks, broadphase::HostBroadphase};
use riprap::scene::build::block_setup;
use riprap::scene::*;

use crate::{CHANNEL, read, refused};
use kit::{assert_contains, assert_near};

/// A dam of water in a tank, open above, its sides periodic.
pub const TANK: &str = r#"
[domain]
size = [4.0, 1.0, 2.0]
[fluid]
acceleration = [0, 0, -9.81]
[particles]
spacing = 0.05
[boundaries]
x_min = { kind = "wall" }
x_max = { kind = "free_slip" }
z_min = { kind = "wall" }
z_max = { kind = "open" }
[[water]]
kind = "box"
size = [1.0, 1.0, 1.0]
position = [0.5, 0.5, 0.5]
[run]
duration = 1
"#;

fn tank(more: &str) -> riprap::Result<Scene> {
    read(&format!("{TANK}{more}"))
}

fn changed(from: &str, to: &str) -> riprap::Result<Scene> {
    assert!(TANK.contains(from));
    read(&TANK.replace(from, to))
}

#[test]
fn a_minimal_tank_has_the_documented_defaults() {
    let scene = tank("").unwrap();
    assert!(scene.has_particles() && scene.has_fluid() && !scene.has_blocks());
    let particles = scene.particles.unwrap();
    assert_eq!(particles, Particles::of(0.05));
    assert_eq!(
        (particles.smoothing, particles.courant, particles.plane),
        (2.0, 0.7, false)
    );
    assert_eq!(particles.largest_speed, None);
    assert_eq!(particles.artificial_viscosity, 0.005);
    assert_eq!(particles.density_diffusion, 0.1);
    assert_eq!(particles.equation_of_state, EquationOfState::Linear);
    assert_eq!((particles.layers(), particles.smoothing_length()), (4, 0.1));
    assert_eq!(scene.water[0].velocity, [0.0; 3]);
    assert_eq!((scene.fluid.density, scene.fluid.viscosity), (1000.0, 0.0));
    assert_eq!(scene.boundaries.z_max, Boundary::Open);
}

#[test]
fn layers_reach_as_far_as_the_kernel() {
    let layers = |smoothing| Particles {
        smoothing,
        ..Particles::of(0.3)
    };
    for (smoothing, count) in [(1.2, 3), (1.3, 3), (1.5, 3), (2.0, 4), (2.1, 5), (3.0, 6)] {
        assert_eq!(layers(smoothing).layers(), count, "{smoothing}");
    }
}

#[test]
fn every_key_of_particles_is_understood() {
    let scene = read(
        r#"
[domain]
size = [4.0, 0.123, 2.0]
[fluid]
density = 998
viscosity = 1e-6
acceleration = [0, 0, -9.81]
[particles]
spacing = 0.05
smoothing = 1.5
scheme = "delta"
equation_of_state = "tait"
largest_speed = 5
artificial_viscosity = 0
density_diffusion = 0.2
courant = 0.1
plane = true
[boundaries]
x_min = { kind = "wall" }
x_max = { kind = "wall" }
z_min = { kind = "wall" }
z_max = { kind = "open" }
[[water]]
kind = "vertices"
vertices = [[0,0,0],[1,0,0],[0,1,0],[0,0,1]]
position = [0.1, 0, 0.2]
rotation = { axis = [0, 1, 0], angle = 10 }
velocity = [1, 0, 0]
[run]
duration = 1
[output]
fields = ["velocity", "pressure", "density"]
[[output.histories]]
quantities = ["mass", "kinetic_energy", "potential_energy", "max_speed", "momentum_x"]
[[probes]]
name = "level"
kind = "gauge"
at = [1, 0.1]
every = 0.1
[[probes]]
name = "sensor"
kind = "point"
at = [1, 0.1, 0.2]
fields = ["pressure"]
[[probes]]
name = "front"
kind = "run_up"
min = [0, 0, 0]
max = [4, 0.1, 2]
direction = "+x"
"#,
    )
    .unwrap();
    let particles = scene.particles.unwrap();
    assert_eq!(particles.equation_of_state, EquationOfState::Tait);
    assert_eq!(particles.largest_speed, Some(5.0));
    assert!(particles.plane);
    assert_eq!(scene.water[0].rotation.angle, 10.0);
    assert_eq!(scene.probes[0].place, ProbePlace::Gauge { at: [1.0, 0.1] });
    assert!(matches!(
        scene.probes[2].place,
        ProbePlace::RunUp {
            direction: Direction::PlusX,
            ..
        }
    ));
}

#[test]
fn walls_hold_water_without_a_material() {
    let solid = "[[solids]]\nkind = \"box\"\nmin = [2, 0, 0]\nmax = [3, 1, 1]\n";
    let setup = block_setup(&tank(solid).unwrap()).unwrap().setup;
    let names: Vec<&str> = setup.blocks.iter().map(|b| b.name.as_str()).collect();
    assert_eq!(names, ["solid_1", "wall_x_min", "wall_x_max", "wall_z_min"]);
    assert_eq!(setup.materials.len(), 1);
}

#[test]
fn blocks_meet_across_periodic_sides_but_not_in_a_plane() {
    let period = |scene: riprap::Result<Scene>| block_setup(&scene.unwrap()).unwrap().setup.period;
    let found = period(tank("")).expect("the sides are periodic");
    assert_eq!(found.origin, glam::DVec3::ZERO);
    assert_eq!(found.size.to_array(), [f64::INFINITY, 1.0, f64::INFINITY]);
    let plane = changed("spacing = 0.05", "spacing = 0.05\nplane = true");
    assert_eq!(period(plane), None);
    let flow = period(read(CHANNEL)).expect("some faces are periodic");
    assert!(flow.size.min_element().is_finite());
}

#[test]
fn blocks_of_a_plane_scene_stay_in_the_plane() {
    let block = |keys: &str| {
        let stone = format!(
            r#"
            [[materials]]
            name = "rock"
            density = 2650
            normal_stiffness = 1e8
            friction = 30
            [[blocks]]
            name = "stone"
            kind = "box"
            size = [0.4, 1, 0.4]
            position = [2, 0.5, 1.5]
            {keys}
            "#
        );
        let text = TANK.replace("spacing = 0.05", "spacing = 0.05\nplane = true") + &stone;
        block_setup(&read(&text).unwrap())
    };
    for keys in [
        "velocity = [1, 0, -1]",
        "spin = [0, 2, 0]",
        "motion = \"driven\"\nvelocity = [\"t\", 0, \"sin(t)\"]\nspin = [0, \"t\", 0]",
        "acceleration = [\"t\", 0, 1]",
        "point_loads = [{ point = [0.2, 0, 0.2], force = [1, 0, \"t\"] }]",
        "guide = [1, 0, 1]",
    ] {
        block(keys).unwrap();
    }
    for (keys, what) in [
        ("velocity = [0, 1, 0]", "velocity"),
        ("spin = [1, 0, 0]", "spin"),
        ("motion = \"driven\"\nvelocity = [0, \"t\", 0]", "velocity"),
        ("motion = \"driven\"\nspin = [0, 0, \"t\"]", "spin"),
        ("acceleration = [0, \"t\", 0]", "acceleration"),
        (
            "point_loads = [{ point = [0, 0.1, 0], force = [1, 0, 0] }]",
            "point load",
        ),
        (
            "point_loads = [{ point = [0, 0, 0], force = [0, 1, 0] }]",
            "point load",
        ),
        ("guide = [0, 1, 1]", "guide"),
    ] {
        let error = block(keys).unwrap_err().to_string();
        assert_contains(&error, &["block stone", what, "plane scene"]);
    }
}

/// −1.2 + 7.6 is 6.3999… in binary.
#[test]
fn probes_reach_the_end_of_the_domain_whatever_rounding_makes_of_it() {
    let rounded = TANK.replace("size = [4.0,", "origin = [-1.2, 0, 0]\nsize = [7.6,");
    let probe = |end: f64| {
        let keys = "kind = \"box\"\nname = \"all\"\nmin = [-1.2, 0, 0]";
        read(&format!(
            "{rounded}[[probes]]\n{keys}\nmax = [{end}, 1, 2]\n"
        ))
    };
    // −1.2 + 7.6 is less than 6.4 in f64.
    probe(6.4).unwrap();
    refused(probe(6.4001), &["probes[0].max", "outside the domain"]);
}

/// The documentation of scenes states what a table holds without water.
#[test]
fn the_schema_says_what_dry_probes_write() {
    let schema = serde_json::to_value(schemars::schema_for!(ProbePlace)).unwrap();
    let kinds = schema["oneOf"].as_array().unwrap();
    for name in ["point", "line", "box", "gauge", "run_up"] {
        let of = |kind: &&serde_json::Value| kind["properties"]["kind"]["const"] == name;
        let kind = kinds.iter().find(of).expect(name);
        let told = kind["description"].as_str().unwrap();
        assert!(told.contains("NaN"), "{name}: {told}");
    }
}

#[test]
fn a_gauge_across_gravity_has_a_warning() {
    let gauge = "[[probes]]\nname = \"level\"\nkind = \"gauge\"\nat = [0.5, 0.5]\n";
    let upright = format!("{TANK}{gauge}");
    let tilted = upright.replace("[0, 0, -9.81]", "[-9.81, 0, -5]");
    assert!(read(&upright).unwrap().suspicious_keys(1e-3).is_empty());
    let found = read(&tilted).unwrap().suspicious_keys(1e-3);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].place, "probes.level");
}

/// Nothing moves along y in a plane scene.
#[test]
fn plane_scenes_refuse_what_moves_along_y() {
    let rock = "[[materials]]\nname = \"rock\"\ndensity = 2600\nnormal_stiffness = 1e8\nfriction = 30\n\
                youngs_modulus = 1e9\npoissons_ratio = 0.25\n\
                [[blocks]]\nname = \"b\"\nkind = \"box\"\nsize = [1, 1, 0.5]\nposition = [3, 0.5, 0.25]\n";
    let plane = |from: &str, to: &str, more: &str| {
        let scene = TANK
            .replace("spacing = 0.05", "spacing = 0.05\nplane = true")
            .replace(from, to);
        read(&format!("{scene}{rock}{more}")).and_then(|scene| block_setup(&scene))
    };
    assert!(plane("", "", "deformable = true").is_ok());
    let run = "[run]";
    let refusals = [
        plane("[run]", "velocity = [1, 0.1, 0]\n[run]", ""),
        plane(run, "[rock]\ngravity = [0, -1, -9.81]\n[run]", ""),
        plane(run, run, "velocity = [0, 0.1, 0]"),
        plane(
            run,
            run,
            "deformable = true\ninitial_stress = [0, 0, 0, 1e5, 0, 0]",
        ),
    ];
    let refusals = refusals.map(|found| found.unwrap_err().to_string());
    insta::assert_snapshot!(refusals.join("\n"));
}

/// A free block with the initial stress s along x relaxes along x and z. In plane strain −ν s remains along y.
#[test]
fn deformable_blocks_of_plane_scenes_are_in_plane_strain() {
    let scene = TANK.replace("spacing = 0.05", "spacing = 0.05\nplane = true")
        + "[rock]\ngravity = [0, 0, 0]\nmass_damping = 200\n\
           [[materials]]\nname = \"rock\"\ndensity = 2600\nnormal_stiffness = 1e8\nfriction = 30\n\
           youngs_modulus = 1e8\npoissons_ratio = 0.25\n\
           [[blocks]]\nname = \"b\"\nkind = \"box\"\nsize = [1, 1, 0.5]\nposition = [3, 0.5, 1]\n\
           deformable = true\ninitial_stress = [1e4, 0, 0, 0, 0, 0]\n";
    let setup = block_setup(&read(&scene).unwrap()).unwrap().setup;
    let mut blocks = Blocks::new(setup).unwrap();
    pollster::block_on(blocks.advance(&mut HostBroadphase, 0.2)).unwrap();
    let stress = blocks.stress(0).unwrap();
    for (axis, expected) in [0.0, -0.25e4, 0.0].into_iter().enumerate() {
        assert_near(stress.col(axis)[axis], expected, 20.0);
    }
}
