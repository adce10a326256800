//! Scenes of blocks: every key, the defaults, and the resulting blocks.

use glam::{DMat3, DVec3};
use kit::{assert_contains, assert_near};
use riprap::rock;
use riprap::scene::build::{block_setup, lattice_setup};
use riprap::scene::*;
use riprap::units::Units;

use crate::{read, refused, solids::scratch, warnings::STONE};

/// A scene of one cube.
pub const CUBE: &str = r#"
[[materials]]
name = "granite"
density = 2700
normal_stiffness = 1e9
friction = 30
[[blocks]]
kind = "box"
size = [1, 2, 3]
[run]
steps = 10
"#;

fn setup(text: &str) -> riprap::Result<rock::Setup> {
    Ok(block_setup(&read(text)?)?.setup)
}

#[test]
fn a_dry_scene_needs_neither_fluid_nor_domain() {
    let scene = read(CUBE).unwrap();
    assert!(scene.has_blocks() && !scene.has_fluid() && !scene.domain.is_given());
    assert_eq!(scene.rock.gravity, [0.0, 0.0, -9.81]);
    assert_eq!(scene.rock, Rock::default());
    let material = &scene.materials[0];
    assert_eq!((material.shear_stiffness(), material.damping), (0.8e9, 0.1));
    let block = &scene.blocks[0];
    assert_eq!((block.motion, block.position), (Motion::Free, [0.0; 3]));
    let setup = block_setup(&scene).unwrap().setup;
    assert_eq!(setup.blocks[0].name, "block_1");
    assert_eq!(setup.blocks[0].shape.volume(), 6.0);
    assert_eq!(setup.gravity.z, -9.81);
}

#[test]
fn every_key_of_blocks_is_understood() {
    let scene = read(
        r#"
[domain]
size = [20, 20, 20]
[rock]
gravity = [0, -9.81, 0]
mass_damping = 0.5
time_step = 1e-5
skin = 0.05
sleep = { speed = 1e-4, time = 0.2 }
largest_overlap = 0.3
corner_area = 0.25
relax = true
broadphase = "device"
[[materials]]
name = "a"
density = 2700
normal_stiffness = 1e9
shear_stiffness = 5e8
friction = 30
cohesion = 1e3
tensile_strength = 1e2
damping = 0.2
[[material_pairs]]
between = ["a", "a"]
normal_stiffness = 2e9
shear_stiffness = 1e9
friction = 20
cohesion = 0
tensile_strength = 0
damping = 0.3
[[blocks]]
name = "v"
kind = "vertices"
vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
position = [1, 1, 1]
rotation = { axis = [0, 0, 2], angle = 90 }
velocity = [1, 0, 0]
spin = [0, 0, 1]
material = "a"
[[blocks]]
name = "h"
kind = "half_spaces"
faces = [{ normal = [-1, 0, 0], distance = 0 }, { normal = [0, -1, 0], distance = 0 }, { normal = [0, 0, -1], distance = 0 }, { normal = [1, 1, 1], distance = 0.57735 }]
position = [3, 1, 1]
motion = "fixed"
[[blocks]]
kind = "tetrahedron"
edge = 1
position = [5, 1, 1]
[[blocks]]
kind = "octahedron"
edge = 1
position = [7, 1, 1]
[[blocks]]
kind = "dodecahedron"
edge = 0.5
position = [9, 2, 2]
[[blocks]]
kind = "icosahedron"
edge = 0.5
position = [12, 2, 2]
[[blocks]]
name = "s"
kind = "sphere"
radius = 0.5
position = [14, 2, 2]
motion = "driven"
velocity = ["sin(t)", 0, 0]
[[blocks]]
name = "c"
kind = "compound"
parts = [
  { kind = "box", size = [1, 1, 1] },
  { kind = "sphere", radius = 0.5, position = [1, 0, 0], rotation = { axis = [1, 0, 0], angle = 10 } },
]
position = [16, 2, 2]
repeat = [{ count = 2, step = [0, 3, 0] }, { count = 2, step = [0, 0, 3] }]
[[rock_masses]]
name = "m"
kind = "box"
min = [1, 10, 1]
max = [5, 14, 5]
joints = [{ dip = 30, dip_direction = 90, spacing = 1, distribution = "normal", scatter = 0.2, origin = [3, 12, 3], persistence = { fraction = 0.5, length = 2 } }]
seed = 3
up = [0, 0, 1]
north = [0, 1, 0]
smallest_volume = 1e-3
smallest_thickness = 1e-3
fixed = [{ kind = "half_space", point = [0, 0, 2], normal = [0, 0, 1] }]
removed = [{ kind = "sphere", center = [0, 0, 0], radius = 1 }]
[[solids]]
kind = "half_space"
point = [0, 0, 0]
normal = [0, 0, 1]
material = "a"
[run]
duration = 1
[output]
every = 0.1
contacts = false
[[output.histories]]
quantities = ["block_kinetic_energy", "block_potential_energy", "contact_energy", "friction_work", "damping_work", "contact_loss", "outside_work", "energy_error", "contacts", "awake_blocks", "block_max_speed"]
[[probes]]
name = "p"
kind = "block"
block = "c_3"
every = 0.01
[[views]]
name = "front"
from = [10, -20, 10]
to = [10, 10, 0]
up = [0, 0, 1]
field_of_view = 40
size = [640, 480]
speed = 2
ground = 0
every = 0.5
strip = 3
animation = false
"#,
    )
    .unwrap();
    assert_eq!(scene.rock.broadphase, BroadphaseBackend::Device);
    assert_eq!(scene.views[0].size, [640, 480]);
    let setup = block_setup(&scene).unwrap().setup;
    let names: Vec<_> = setup.blocks.iter().map(|b| b.name.as_str()).collect();
    assert_eq!(
        &names[..7],
        ["v", "h", "block_3", "block_4", "block_5", "block_6", "s"]
    );
    assert_eq!(&names[7..11], ["c_1", "c_2", "c_3", "c_4"]);
    assert_eq!((names[11], *names.last().unwrap()), ("m_1", "solid_1"));
    // The vertices rotate about the origin of their frame: (1, 0, 0) goes to (1, 2, 1).
    let tetrahedron = &setup.blocks[0];
    let centroid = tetrahedron.centre.to_array();
    for (got, exact) in centroid.into_iter().zip([0.75, 1.25, 1.25]) {
        assert!((got - exact).abs() < 1e-14, "{centroid:?}");
    }
    assert_eq!(setup.blocks[9].centre.z - setup.blocks[7].centre.z, 3.0);
    let fixed = |name: &str| {
        let block = setup.blocks.iter().find(|b| b.name == name).unwrap();
        block.motion == rock::Motion::Fixed
    };
    assert!(fixed("h") && fixed("solid_1") && !fixed("v"));
    let mass = setup.blocks.iter().filter(|b| b.name.starts_with("m_"));
    assert!(mass.clone().any(|b| b.motion == rock::Motion::Fixed));
    assert!(mass.clone().any(|b| b.motion == rock::Motion::Free));
    let volume: f64 = mass.map(|b| b.shape.volume()).sum();
    assert!((volume - 64.0).abs() < 0.1, "{volume}");
}

/// n copies rotated by 2π/n about an axis close the circle: the last one is one step before the first.
#[test]
fn copies_slide_along_the_same_guide() {
    let more = "size = [1, 2, 3]\nguide = [0, 0, -2]\nrepeat = { count = 2, step = [3, 0, 0] }";
    let setup = setup(&CUBE.replace("size = [1, 2, 3]", more)).unwrap();
    let axis = DVec3::new(0.0, 0.0, -2.0);
    assert_eq!(
        setup.guides,
        [0, 1].map(|block| rock::Guide { block, axis })
    );
}

#[test]
fn rows_that_turn_go_round() {
    let blocks = setup(&CUBE.replace(
        "size = [1, 2, 3]",
        "size = [1, 1, 1]\nposition = [5, 0, 0]\n\
         repeat = { count = 8, turn = { axis = [0, 0, 1], angle = 45 }, about = [1, 0, 0] }",
    ))
    .unwrap()
    .blocks;
    assert_eq!(blocks.len(), 8);
    assert_eq!(blocks[7].name, "block_1_8");
    for (k, block) in blocks.iter().enumerate() {
        let angle = f64::to_radians(45.0 * k as f64);
        let place = glam::DVec3::new(1.0 + 4.0 * angle.cos(), 4.0 * angle.sin(), 0.0);
        assert!(
            block.centre.distance(place) < 1e-14,
            "{k}: {}",
            block.centre
        );
        let x = block.rotation * glam::DVec3::X;
        assert!(x.distance(glam::DVec3::new(angle.cos(), angle.sin(), 0.0)) < 1e-14);
    }
}

/// A solid half-space is as thick as the domain is wide, so that blocks do not fall off its edge soon.
#[test]
fn a_half_space_becomes_a_box_beyond_the_domain() {
    let text = format!(
        "{CUBE}[domain]\norigin = [-2, -2, -1]\nsize = [4, 4, 5]\n\
         [[solids]]\nkind = \"half_space\"\npoint = [0, 0, 0]\nnormal = [0, 0, 3]\n"
    );
    let ground = setup(&text).unwrap().blocks.pop().unwrap();
    assert!((ground.shape.volume() - 14.0 * 14.0 * 6.0).abs() < 1e-9);
    assert!((ground.centre.z + 3.0).abs() < 1e-12, "{}", ground.centre);
}

/// A cube of 2 m cut at a height of 0.5 m, into 2 and 6 m³.
fn cut_cube(keys: &str) -> Scene {
    read(&format!(
        "[[materials]]\nname = \"rock\"\ndensity = 2700\nnormal_stiffness = 1e9\nfriction = 30\n\
         [[rock_masses]]\nname = \"mass\"\nkind = \"box\"\nmin = [0, 0, 0]\nmax = [2, 2, 2]\n{keys}\n\
         joints = [{{ dip = 0, dip_direction = 0, spacing = 1.5, distribution = \"none\", \
         origin = [0, 0, 0.5] }}]\n[run]\nduration = 1\n"
    ))
    .unwrap()
}

#[test]
fn keys_of_rock_masses_without_effect_are_warned_of() {
    let nowhere = "[{ kind = \"box\", min = [5, 5, 5], max = [6, 6, 6] }]";
    for key in ["fixed", "removed"] {
        let found = block_setup(&cut_cube(&format!("{key} = {nowhere}"))).unwrap();
        assert_eq!(found.setup.blocks.len(), 2);
        let [warning] = &found.advice[..] else {
            panic!("{:?}", found.advice);
        };
        assert_eq!(warning.place, format!("rock_masses[0].{key}"));
    }
    let all = "[{ kind = \"box\", min = [0, 0, 0], max = [2, 2, 2] }]";
    let found = block_setup(&cut_cube(&format!("fixed = {all}"))).unwrap();
    assert!(found.advice.is_empty(), "{:?}", found.advice);
}

#[test]
fn a_rock_mass_of_a_mesh_that_is_not_convex_is_warned_of() {
    let dir = scratch("not_convex");
    // A prism over an L of three unit squares: its hull has 3.5 m³.
    let outline = [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]];
    let mut mesh = String::new();
    for y in 0..2 {
        for [x, z] in outline {
            mesh += &format!("v {x} {y} {z}\n");
        }
    }
    for [a, b, c] in [[1, 2, 3], [1, 3, 4], [1, 4, 6], [4, 5, 6]] {
        mesh += &format!("f {a} {b} {c}\nf {} {} {}\n", a + 6, c + 6, b + 6);
    }
    for (a, b) in (1..7).map(|n| (n, n % 6 + 1)) {
        mesh += &format!("f {a} {} {b}\nf {b} {} {}\n", a + 6, a + 6, b + 6);
    }
    std::fs::write(dir.join("l.obj"), mesh).unwrap();
    let text = "[[materials]]\nname = \"rock\"\ndensity = 2700\nnormal_stiffness = 1e9\nfriction = 30\n\
                [[rock_masses]]\nname = \"mass\"\nkind = \"mesh\"\nfile = \"l.obj\"\n\
                joints = [{ dip = 0, dip_direction = 0, spacing = 9, origin = [0, 0, 0.5] }]\n[run]\nduration = 1\n";
    let scene = Scene::from_toml(text, &dir, "mass.toml").unwrap();
    let found = block_setup(&scene).unwrap();
    let [warning] = &found.advice[..] else {
        panic!("{:?}", found.advice);
    };
    assert_eq!(warning.place, "rock_masses[0].file");
    assert_contains(&warning.message, &["not convex", "16.7 %"]);
}

#[test]
fn rock_masses_of_which_nothing_is_left_are_refused() {
    let all = "removed = [{ kind = \"box\", min = [0, 0, 0], max = [2, 2, 2] }]";
    for (keys, words) in [
        (all, "2 of its pieces are in `removed`"),
        ("smallest_volume = 7", "2 are smaller or thinner"),
        ("aperture = 1.9", "2 are narrower than an aperture of 1.9 m"),
    ] {
        let error = block_setup(&cut_cube(keys)).unwrap_err().to_string();
        assert!(
            error.contains("rock_masses[0]") && error.contains(words),
            "{error}"
        );
    }
}

#[test]
fn pieces_that_are_left_out_are_counted() {
    let scene = |least: f64| cut_cube(&format!("smallest_volume = {least}"));
    let whole = block_setup(&scene(0.1)).unwrap();
    assert_eq!((whole.setup.blocks.len(), whole.left_out.len()), (2, 0));
    let trimmed = block_setup(&scene(3.0)).unwrap();
    assert_eq!(trimmed.setup.blocks.len(), 1);
    let [lost] = &trimmed.left_out[..] else {
        panic!("{:?}", trimmed.left_out);
    };
    assert_eq!((lost.mass.as_str(), lost.pieces), ("mass", 1));
    assert!((lost.share - 0.25).abs() < 1e-12, "{}", lost.share);
}

/// A block and a solid in a channel, with a probe of `block` and one called `other`.
fn probed(block: &str, other: &str) -> riprap::Result<Scene> {
    crate::channel(&format!(
        r#"
        [[materials]]
        name = "granite"
        density = 2700
        normal_stiffness = 1e9
        friction = 30
        [[solids]]
        name = "step"
        kind = "box"
        min = [0, 0, 0]
        max = [0.002, 0.01, 0.004]
        [[blocks]]
        name = "stone"
        kind = "box"
        size = [0.002, 0.002, 0.002]
        position = [0.01, 0.005, 0.002]
        [[probes]]
        name = "load"
        kind = "block"
        block = "{block}"
        faces = true
        safety = true
        [[probes]]
        name = "{other}"
        kind = "block"
        block = "stone"
        "#
    ))
}

#[test]
fn a_probe_of_a_block_may_ask_for_its_faces_and_its_safety() {
    let scene = probed("stone", "other").unwrap();
    let asked = |place: &ProbePlace| match place {
        ProbePlace::Block { faces, safety, .. } => [*faces, *safety],
        _ => panic!("no probe of a block"),
    };
    assert_eq!(asked(&scene.probes[0].place), [true; 2]);
    assert_eq!(asked(&scene.probes[1].place), [false; 2]);
    block_setup(&scene).unwrap();
    refused(
        probed("stone", "load_faces"),
        &["probes[1].name", "`load_faces`"],
    );
    refused(
        block_setup(&probed("step", "other").unwrap()),
        &["probes[0].faces", "`step` is a solid"],
    );
    let mut round = probed("stone", "other").unwrap();
    round.blocks[0].shape = BlockShape::Sphere { radius: 0.001 };
    refused(
        block_setup(&round),
        &["probes[0].faces", "`stone` is a sphere"],
    );
}

/// Blocks and a rock mass that deform.
pub const BAR: &str = r#"
[[materials]]
name = "rock"
density = 2700
normal_stiffness = 1e9
friction = 30
youngs_modulus = 2e10
[[materials]]
name = "hard"
density = 2700
normal_stiffness = 1e9
friction = 30
[[blocks]]
name = "bar"
kind = "vertices"
vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 4], [1, 0, 4], [0, 1, 4], [1, 1, 4]]
position = [0, 0, 1]
deformable = true
initial_stress = [1e5, -2e5, 3e5, 4e4, 5e4, 6e4]
fixed_points = [{ point = [0.5, 0.5, 4] }, { point = [1, 0.5, 4], axes = ["z", "x"] }]
point_loads = [{ point = [0.5, 0.5, 0], force = [0, "10*t", -5] }]
acceleration = ["sin(t)", 0, 0]
repeat = { count = 2, step = [3, 0, 0] }
[[blocks]]
name = "ball"
kind = "sphere"
radius = 0.5
position = [0, 5, 0]
point_loads = [{ point = [0.5, 0, 0], force = [0, 0, 1] }]
[[rock_masses]]
name = "mass"
kind = "box"
min = [10, 0, 0]
max = [12, 2, 2]
joints = [{ dip = 0, dip_direction = 0, spacing = 1, origin = [0, 0, 1] }]
deformable = true
fixed = [{ kind = "box", min = [10, 0, 0], max = [12, 2, 1] }]
[run]
duration = 1
"#;

#[test]
fn keys_become_deformable_blocks_and_loads() {
    let setup = setup(BAR).unwrap();
    let elastic = setup.materials[0].elastic.unwrap();
    assert_eq!(
        (elastic.youngs_modulus, elastic.poissons_ratio),
        (2e10, 0.25)
    );
    assert_eq!(setup.materials[1].elastic, None);
    for bar in &setup.blocks[..2] {
        let deformable = bar.deformable.as_ref().unwrap();
        let stress = DMat3::from_cols(
            DVec3::new(1e5, 4e4, 6e4),
            DVec3::new(4e4, -2e5, 5e4),
            DVec3::new(6e4, 5e4, 3e5),
        );
        assert_eq!(deformable.initial_stress, stress);
        // From the centroid at (0.5, 0.5, 2).
        let [hinge, roller] = deformable.fixed_points[..] else {
            panic!("two points")
        };
        assert!((hinge.point - DVec3::Z * 2.0).length() < 1e-12);
        assert_eq!((hinge.axes, roller.axes), ([true; 3], [true, false, true]));
        assert!((bar.point_loads[0].point + DVec3::Z * 2.0).length() < 1e-12);
        assert_eq!(bar.point_loads[0].force[1].text(), "10*t");
        assert_eq!(bar.acceleration.as_ref().unwrap()[0].text(), "sin(t)");
    }
    assert!(setup.blocks[2].deformable.is_none());
    assert_eq!(setup.blocks[2].point_loads.len(), 1);
    // Of the two blocks of the mass one is fixed, and rigid.
    let mass: Vec<bool> = setup.blocks[3..]
        .iter()
        .map(|b| b.deformable.is_some())
        .collect();
    assert_eq!(
        mass.iter().filter(|deforms| **deforms).count(),
        1,
        "{mass:?}"
    );
    riprap::rock::Blocks::new(setup).unwrap();
}

#[test]
fn joints_have_apertures_that_the_lattice_can_have() {
    let setup = |aperture: &str| {
        let scene = read(&STONE.replace("hold = 0", &format!("joint_aperture = {aperture}")));
        let scene = scene.unwrap();
        let units = Units::of(&scene).unwrap();
        (lattice_setup(&scene, &units, None), units.cell)
    };
    let (made, cell) = setup("1.5e-3");
    assert_near(made.unwrap().joint_aperture.unwrap(), 1.5e-3 / cell, 1e-12);
    let refused = setup("1").0.unwrap_err().to_string();
    assert!(refused.contains("coupling.joint_aperture"), "{refused}");
    // The bounds as printed are in the range.
    let bounds: Vec<_> = refused
        .split_whitespace()
        .filter(|word| word.contains("e-"))
        .collect();
    assert_eq!(bounds.len(), 2, "{refused}");
    for bound in bounds {
        assert!(setup(bound).0.is_ok(), "{bound}");
    }
}
