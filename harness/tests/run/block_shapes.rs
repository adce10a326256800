//! Blocks cut by joints that are partly open, and blocks from meshes, from the scene to the forces.

use crate::fixture::{args, check, folder, go, last, restarted};
use kit::{assert_contains, assert_relative};
use riprap_harness::run::run;
use std::{fs, path::Path, sync::atomic::AtomicBool};

/// kg/m³.
const DENSITY: f64 = 2700.0;
/// m/s².
const GRAVITY: f64 = 9.81;

const MATERIAL: &str = r#"
[[materials]]
name = "rock"
density = 2700
normal_stiffness = 1e8
friction = 30
"#;

/// 64 columns of 1 m × 1 m × 2 m, crossed at three quarters of their height by one joint whose open part is given by
/// `open`. Blocks that reach below half of the height are fixed; gravity points upwards.
fn columns(open: &str) -> String {
    format!(
        r#"
{MATERIAL}
[rock]
gravity = [0, 0, {GRAVITY}]
[[rock_masses]]
name = "m"
kind = "box"
min = [0, 0, 0]
max = [8, 8, 2]
seed = 11
up = [0, 0, 1]
joints = [
  {{ dip = 90, dip_direction = 90, spacing = 1 }},
  {{ dip = 90, dip_direction = 0, spacing = 1 }},
  {{ dip = 0, dip_direction = 0, spacing = 9, origin = [0, 0, 1.5]{open} }},
]
fixed = [{{ kind = "half_space", point = [0, 0, 1.1], normal = [0, 0, 1] }}]
[[blocks]]
name = "alone"
kind = "box"
size = [1, 1, 1]
position = [20, 0, 0]
[run]
duration = 0.05
[output]
every = 0.025
"#
    )
}

/// Number of free blocks on 64 columns, all of which must fall off.
fn come_off(open: &str, name: &str) -> usize {
    let folder = folder(name);
    let text = columns(open);
    let (told, _) = check(&folder, &text);
    let free = told["free"].as_u64().unwrap() as usize - 1;
    assert_eq!(told["blocks"].as_u64().unwrap() as usize, 65 + free);
    // Nothing holds the free pieces: ½m(gt)², of half a cubic metre each and of `alone`.
    let summary = go(&args(&folder, &text, "out"));
    let mass = DENSITY * (0.5 * free as f64 + 1.0);
    assert_relative(told["mass"].as_f64().unwrap(), mass, 1e-9);
    let exact = 0.5 * mass * (GRAVITY * 0.05f64).powi(2);
    assert_relative(summary.rocks.as_ref().unwrap().ledger.kinetic, exact, 1e-9);
    free
}

#[test]
fn rock_comes_off_where_a_joint_is_open() {
    assert_eq!(come_off("", "shapes_open"), 64);
    let share = |fraction: f64| format!(", persistence = {{ fraction = {fraction}, length = 1 }}");
    assert_eq!(come_off(&share(1.0), "shapes_all"), 64);
    assert_eq!(come_off(&share(0.0), "shapes_none"), 0);
    // An open square for half of the columns: 32 ± 4 of 64.
    let half = come_off(&share(0.5), "shapes_half");
    assert!((16..=48).contains(&half), "{half}");
}

#[test]
fn a_mass_of_partly_open_joints_restarts_to_the_same_bits() {
    let text = columns(", persistence = { fraction = 0.5, length = 1 }")
        .replace("duration = 0.05", "steps = 20");
    restarted(&folder("shapes_restart"), &text, 7, &["checkpoint.riprap"]);
}

/// Outline of an L of 3 m × 2 m, counter-clockwise, and its triangles.
const OUTLINE: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [3.0, 0.0],
    [3.0, 1.0],
    [1.0, 1.0],
    [1.0, 2.0],
    [0.0, 2.0],
];
const TRIANGLES: [[usize; 3]; 4] = [[0, 1, 2], [0, 2, 3], [0, 3, 5], [3, 4, 5]];

/// The L, 1 m thick along y and upright, in millimetres.
fn write_l(folder: &Path) {
    let corner = |i: usize, y: f64| [OUTLINE[i][0], y, OUTLINE[i][1]].map(|x| 1000.0 * x);
    let mut facets = Vec::new();
    for [a, b, c] in TRIANGLES {
        facets.push([corner(a, 0.0), corner(b, 0.0), corner(c, 0.0)]);
        facets.push([corner(a, 1.0), corner(c, 1.0), corner(b, 1.0)]);
    }
    for i in 0..6 {
        let j = (i + 1) % 6;
        facets.push([corner(i, 0.0), corner(j, 1.0), corner(j, 0.0)]);
        facets.push([corner(i, 0.0), corner(i, 1.0), corner(j, 1.0)]);
    }
    let mut text = String::from("solid l\n");
    for facet in facets {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in facet {
            text += &format!("vertex {x} {y} {z}\n");
        }
        text += "endloop\nendfacet\n";
    }
    fs::write(folder.join("l.stl"), text + "endsolid l\n").unwrap();
}

/// The L or its hull on a floor, damped until it rests.
fn lying(hull: bool, more: &str) -> String {
    format!(
        r#"
{MATERIAL}
[rock]
mass_damping = 60
[[solids]]
kind = "box"
name = "floor"
min = [-5, -5, -1]
max = [9, 5, 0]
[[blocks]]
name = "l"
kind = "mesh"
file = "l.stl"
scale = 1e-3
hull = {hull}
{more}
[run]
duration = 0.5
[output]
every = 0.25
[[probes]]
name = "l"
kind = "block"
block = "l"
every = 0.1
"#
    )
}

/// A cube in the angle of the L, clear of it but inside its hull.
const CUBE: &str = r#"
[[blocks]]
name = "cube"
kind = "box"
size = [0.4, 0.4, 0.4]
position = [1.25, 0.5, 1.2]
"#;

#[test]
fn a_mesh_and_its_hull_lie_on_a_floor_with_their_own_weights() {
    // Six square metres less the angle, and less half of it for the hull.
    for (hull, area, parts) in [(false, 4.0, 2), (true, 5.0, 1)] {
        let folder = folder(&format!("shapes_lying_{hull}"));
        write_l(&folder);
        let (told, _) = check(&folder, &lying(hull, ""));
        assert_eq!(told["parts"], 1 + parts);
        assert_relative(told["mass"].as_f64().unwrap(), DENSITY * area, 1e-9);
        go(&args(&folder, &lying(hull, ""), "out"));
        let table = folder.join("out/l.csv");
        let weight = DENSITY * area * GRAVITY;
        let held = last(&table, "force_z");
        assert_relative(held, weight, 1e-4);
        // No sideways force: the pressure is centred under the centroid.
        let turned = last(&table, "rotation_y").abs();
        assert!(turned < 0.01, "{turned}°");
    }
}

#[test]
fn a_block_fits_into_the_angle_of_a_mesh_but_not_of_its_hull() {
    let folder = folder("shapes_angle");
    write_l(&folder);
    go(&args(&folder, &lying(false, CUBE), "mesh"));
    let hull = args(&folder, &lying(true, CUBE), "hull");
    let Err(refused) = run(&hull, &AtomicBool::new(false)) else {
        panic!("the cube is in the hull");
    };
    assert_contains(refused, &["overlap", "cube", "(l)"]);
}

#[test]
fn a_rock_mass_in_the_hull_of_a_mesh_is_cut_without_loss() {
    let folder = folder("shapes_mass");
    write_l(&folder);
    let text = format!(
        r#"
{MATERIAL}
[[rock_masses]]
name = "m"
kind = "mesh"
file = "l.stl"
scale = 1e-3
translate = [0, 0, 5]
joints = [
  {{ dip = 0, dip_direction = 0, spacing = 0.7, origin = [0, 0, 5.3] }},
  {{ dip = 60, dip_direction = 90, spacing = 0.8, origin = [1, 0, 5] }},
]
[run]
duration = 0.05
[output]
every = 0.05
"#
    );
    let (told, _) = check(&folder, &text);
    assert!(told["free"].as_u64().unwrap() > 6);
    let mass = DENSITY * 5.0;
    assert_relative(told["mass"].as_f64().unwrap(), mass, 1e-9);
    // In free fall the pieces do not press on each other.
    let kinetic = go(&args(&folder, &text, "out"))
        .rocks
        .as_ref()
        .unwrap()
        .ledger
        .kinetic;
    let exact = 0.5 * mass * (GRAVITY * 0.05f64).powi(2);
    assert_relative(kinetic, exact, 1e-9);
}
