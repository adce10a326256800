//! Solid cells.

use std::fs::{self, File};
use std::path::PathBuf;

use glam::DVec3;
use kit::assert_near;
use riprap::Result;
use riprap::scene::{Scene, build::lattice_setup};
use riprap::units::Units;
use riprap::{
    geometry::{TriangleMesh, WindingTree},
    scene::static_solids::Mask,
};

use crate::{channel, refused};

/// A scratch directory of one test.
pub(crate) fn scratch(test: &str) -> PathBuf {
    let dir = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(test);
    fs::create_dir_all(&dir).unwrap();
    dir
}

/// Writes triangles as binary STL.
pub(crate) fn write_stl(path: &PathBuf, triangles: &[[DVec3; 3]]) {
    let faces: Vec<_> = triangles
        .iter()
        .map(|corners| stl_io::Triangle {
            normal: stl_io::Normal::new([0.0; 3]),
            vertices: corners.map(|c| stl_io::Vertex::new(c.as_vec3().to_array())),
        })
        .collect();
    stl_io::write_stl(&mut File::create(path).unwrap(), faces.iter()).unwrap();
}

/// The twelve triangles of a box, counter-clockwise seen from outside.
pub(crate) fn cuboid(min: DVec3, max: DVec3) -> Vec<[DVec3; 3]> {
    let mut triangles = Vec::new();
    for axis in 0..3 {
        for (end, outward) in [(min, false), (max, true)] {
            let corner = |u: bool, v: bool| {
                let mut p = min;
                p[axis] = end[axis];
                let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
                p[a] = if u { max[a] } else { min[a] };
                p[b] = if v { max[b] } else { min[b] };
                p
            };
            let [a, b, c, d] = [
                corner(false, false),
                corner(true, false),
                corner(true, true),
                corner(false, true),
            ];
            let both = if outward {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, c, b], [a, d, c]]
            };
            triangles.extend(both);
        }
    }
    triangles
}

/// A sphere of `rings` × 2 `rings` quadrilaterals.
fn ball(centre: DVec3, radius: f64, rings: u32) -> Vec<[DVec3; 3]> {
    let around = 2 * rings;
    let point = |ring: u32, step: u32| {
        let polar = std::f64::consts::PI * f64::from(ring) / f64::from(rings);
        let turn = std::f64::consts::TAU * f64::from(step % around) / f64::from(around);
        // Each pole is a single point.
        let flat = if ring == 0 || ring == rings {
            0.0
        } else {
            polar.sin()
        };
        centre + radius * DVec3::new(flat * turn.cos(), flat * turn.sin(), polar.cos())
    };
    let mut triangles = Vec::new();
    for ring in 0..rings {
        for step in 0..around {
            let [a, b] = [point(ring, step), point(ring, step + 1)];
            let [c, d] = [point(ring + 1, step), point(ring + 1, step + 1)];
            if ring > 0 {
                triangles.push([a, c, b]);
            }
            if ring + 1 < rings {
                triangles.push([b, c, d]);
            }
        }
    }
    triangles
}

fn indexed(triangles: &[[DVec3; 3]]) -> TriangleMesh {
    let vertices: Vec<DVec3> = triangles.iter().flatten().copied().collect();
    let order: Vec<[u32; 3]> = (0..triangles.len() as u32)
        .map(|t| [3 * t, 3 * t + 1, 3 * t + 2])
        .collect();
    TriangleMesh::new(&vertices, &order).unwrap()
}

/// A cube of `cells` cells of 1 mm along an edge with the given solids; meshes are in the scratch directory.
fn cube(test: &str, cells: u32, solids: &str) -> Result<Scene> {
    let edge = f64::from(cells) * 1e-3;
    let text = format!(
        "[domain]\nsize = [{edge}, {edge}, {edge}]\ncell = 1e-3\n[fluid]\nviscosity = 1e-6\n\
         [run]\nsteps = 1\n{solids}"
    );
    Scene::from_toml(&text, &scratch(test), "cube.toml")
}

fn agree(mask: &Mask, scene: &Scene, inside: impl Fn(DVec3) -> bool) {
    let mut solid = mask.as_slice().iter();
    for centre in scene.domain.centres() {
        assert_eq!(
            *solid.next().unwrap() == 1,
            inside(centre.into()),
            "{centre:?}"
        );
    }
}

#[test]
fn boxes_are_half_open() {
    // Both boxes end on centres of cells; each of these is counted once.
    let boxes = "[[solids]]\nkind = \"box\"\nmin = [0.0025, 0, 0]\nmax = [0.0085, 0.01, 0.004]\n";
    let rest = "[[solids]]\nkind = \"box\"\nmin = [0.0085, 0, 0]\nmax = [0.0115, 0.01, 0.004]\n";
    let count = |text: &str| channel(text).unwrap().solid_mask().unwrap().solid_count();
    assert_eq!(count(boxes), 6 * 40);
    assert_eq!(count(rest), 3 * 40);
    assert_eq!(count(&format!("{boxes}{rest}")), 9 * 40);
}

#[test]
fn later_entries_win() {
    let scene = channel(
        "[[solids]]\nkind = \"half_space\"\npoint = [0, 0.005, 0]\nnormal = [0, 3, 0]\n\
         [[solids]]\nkind = \"box\"\nmin = [0.008, 0, 0]\nmax = [0.012, 0.005, 0.004]\nvoid = true\n\
         [[solids]]\nkind = \"box\"\nmin = [0.01, 0, 0]\nmax = [0.012, 0.001, 0.004]\n",
    )
    .unwrap();
    let mask = scene.solid_mask().unwrap();
    assert_eq!(mask.solid_count(), (20 * 5 - 4 * 5 + 2) * 4);
    assert!(mask.is_solid([0, 4, 0]) && !mask.is_solid([0, 5, 0]));
    assert!(!mask.is_solid([8, 0, 0]) && mask.is_solid([10, 0, 3]));
}

#[test]
fn spheres_fill_the_centres_within_their_radius() {
    let solids = "[[solids]]\nkind = \"sphere\"\ncenter = [0.01, 0.01, 0.01]\nradius = 0.0083\n";
    let scene = cube("sphere", 20, solids).unwrap();
    let mask = scene.solid_mask().unwrap();
    agree(&mask, &scene, |x| x.distance(DVec3::splat(0.01)) < 0.0083);
}

#[test]
fn nothing_but_solid_is_refused() {
    let all = "[[solids]]\nkind = \"half_space\"\npoint = [0, 1, 0]\nnormal = [0, 1, 0]\n";
    refused(
        channel(all).unwrap().solid_mask(),
        &["solids", "whole domain", "normal"],
    );
}

#[test]
fn winding_numbers_count_enclosures() {
    let outer = cuboid(DVec3::ZERO, DVec3::ONE);
    let tree = WindingTree::new(&indexed(&outer));
    for (q, w) in [
        (DVec3::splat(0.5), 1.0),
        (DVec3::new(0.001, 0.999, 0.5), 1.0),
        (DVec3::new(-0.001, 0.5, 0.5), 0.0),
        (DVec3::new(3.0, -2.0, 0.1), 0.0),
        // In the planes of faces and on the lines of edges, where ray casting fails.
        (DVec3::new(2.0, 1.0, 1.0), 0.0),
        (DVec3::new(0.5, 0.5, 1.5), 0.0),
    ] {
        assert!((tree.at(q) - w).abs() < 0.01, "{q}: {}", tree.at(q));
    }
    let both: Vec<_> = outer
        .iter()
        .copied()
        .chain(cuboid(DVec3::splat(0.25), DVec3::splat(0.75)))
        .collect();
    assert!((WindingTree::new(&indexed(&both)).at(DVec3::splat(0.5)) - 2.0).abs() < 0.01);
}

#[test]
fn far_dipoles_stay_far_from_the_deciding_half() {
    let tree = WindingTree::new(&indexed(&ball(DVec3::ZERO, 1.0, 40)));
    let mut worst: f64 = 0.0;
    for n in 0..4000_u32 {
        // Points on a spiral from the centre to three radii.
        let s = f64::from(n) / 4000.0;
        let radius = 3.0 * s;
        let (turn, height) = (
            2.4 * f64::from(n),
            2.0 * ((f64::from(n) * 0.618).fract()) - 1.0,
        );
        let flat = (1.0 - height * height).sqrt();
        let q = radius * DVec3::new(flat * turn.cos(), flat * turn.sin(), height);
        // Between the inscribed and the circumscribed sphere the answer depends on the facets.
        if !(0.995..=1.0).contains(&radius) {
            let exact = if radius < 1.0 { 1.0 } else { 0.0 };
            worst = worst.max((tree.at(q) - exact).abs());
        }
    }
    assert!(worst < 0.1, "{worst}");
}

#[test]
fn a_cube_mesh_equals_the_box() {
    let dir = scratch("cube_mesh");
    // Faces lie on cell centres on purpose; the file is in millimetres.
    write_stl(
        &dir.join("cube.stl"),
        &cuboid(DVec3::splat(4.5), DVec3::new(11.5, 12.0, 9.25)),
    );
    let mesh = "[[solids]]\nkind = \"mesh\"\nfile = \"cube.stl\"\nscale = 1e-3\ntranslate = [1e-3, 0, 0]\n";
    let scene = cube("cube_mesh", 16, mesh).unwrap();
    let same = "[[solids]]\nkind = \"box\"\nmin = [0.0055, 0.0045, 0.0045]\nmax = [0.0125, 0.012, 0.00925]\n";
    let reference = cube("cube_mesh", 16, same).unwrap().solid_mask().unwrap();
    assert_eq!(scene.solid_mask().unwrap(), reference);
    assert_eq!(reference.solid_count(), 7 * 8 * 5);
}

#[test]
fn binary_stl_may_begin_like_text() {
    let dir = scratch("solid_header");
    let path = dir.join("cube.stl");
    write_stl(&path, &cuboid(DVec3::splat(2.0), DVec3::splat(6.0)));
    let mut bytes = fs::read(&path).unwrap();
    bytes[..12].copy_from_slice(b"solid cube  ");
    fs::write(&path, bytes).unwrap();
    let mesh = "[[solids]]\nkind = \"mesh\"\nfile = \"cube.stl\"\nscale = 1e-3\n";
    let scene = cube("solid_header", 8, mesh).unwrap();
    assert_eq!(scene.solid_mask().unwrap().solid_count(), 64);
}

#[test]
fn a_mesh_that_reaches_out_of_the_domain_is_cut() {
    let dir = scratch("cut_mesh");
    write_stl(
        &dir.join("cube.stl"),
        &cuboid(DVec3::new(-5.0, 0.002, -5.0), DVec3::new(5.0, 0.006, 5.0)),
    );
    let scene = cube(
        "cut_mesh",
        8,
        "[[solids]]\nkind = \"mesh\"\nfile = \"cube.stl\"\n",
    )
    .unwrap();
    agree(&scene.solid_mask().unwrap(), &scene, |x| {
        x.y > 0.002 && x.y < 0.006
    });
}

#[test]
fn sphere_meshes_fill_hollow_and_inside_out() {
    let dir = scratch("sphere_mesh");
    let centre = DVec3::splat(10.3);
    let outer = ball(centre, 8.0, 24);
    let hole: Vec<_> = ball(centre, 4.0, 24)
        .iter()
        .map(|[a, b, c]| [*a, *c, *b])
        .collect();
    let hollow: Vec<_> = outer.iter().copied().chain(hole).collect();
    let turned: Vec<_> = outer.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    let mask = |name: &str, triangles: &[[DVec3; 3]]| {
        write_stl(&dir.join(name), triangles);
        let mesh = format!("[[solids]]\nkind = \"mesh\"\nfile = \"{name}\"\nscale = 1e-3\n");
        let scene = cube("sphere_mesh", 20, &mesh).unwrap();
        (scene.solid_mask().unwrap(), scene)
    };
    let (full, scene) = mask("full.stl", &outer);
    let tree = WindingTree::new(&indexed(
        &outer
            .iter()
            .map(|t| t.map(|c| c * 1e-3))
            .collect::<Vec<_>>(),
    ));
    agree(&full, &scene, |x| tree.at(x + 1e-7) > 0.5);
    let volume = full.solid_count() as f64 / (4.0 / 3.0 * std::f64::consts::PI * 512.0);
    // The inscribed polyhedron lacks about 2/3·(π/24)² = 1.1 % of the sphere.
    assert!((volume - 0.989).abs() < 0.005, "{volume}");
    assert_eq!(mask("turned.stl", &turned).0, full);
    let (shell, _) = mask("hollow.stl", &hollow);
    let missing = (full.solid_count() - shell.solid_count()) as f64;
    assert!((missing / (4.0 / 3.0 * std::f64::consts::PI * 64.0) - 1.0).abs() < 0.03);
    assert!(!shell.is_solid([10, 10, 10]) && full.is_solid([10, 10, 10]));
}

#[test]
fn overlapping_bodies_in_one_mesh_are_united() {
    let dir = scratch("overlap_mesh");
    let mut both = cuboid(DVec3::splat(2.1), DVec3::splat(8.1));
    both.extend(cuboid(DVec3::splat(5.1), DVec3::splat(11.1)));
    write_stl(&dir.join("two.stl"), &both);
    let mesh = "[[solids]]\nkind = \"mesh\"\nfile = \"two.stl\"\nscale = 1e-3\n";
    let scene = cube("overlap_mesh", 14, mesh).unwrap();
    let within = |x: DVec3, low: f64, high: f64| {
        x.cmpgt(DVec3::splat(low)).all() && x.cmplt(DVec3::splat(high)).all()
    };
    agree(&scene.solid_mask().unwrap(), &scene, |x| {
        within(x, 2.1e-3, 8.1e-3) || within(x, 5.1e-3, 11.1e-3)
    });
}

#[test]
fn obj_files_are_read() {
    let dir = scratch("obj_mesh");
    let quads = "v 2 2 2\nv 6 2 2\nv 6 6 2\nv 2 6 2\nv 2 2 6\nv 6 2 6\nv 6 6 6\nv 2 6 6\n\
                 f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 4 1 5 8\n";
    fs::write(dir.join("cube.obj"), quads).unwrap();
    let mesh = "[[solids]]\nkind = \"mesh\"\nfile = \"cube.obj\"\nscale = 1e-3\n";
    let scene = cube("obj_mesh", 8, mesh).unwrap();
    assert_eq!(scene.solid_mask().unwrap().solid_count(), 64);
}

/// Texts keep the decimals of coordinates that f32 rounds to half a metre; binary STL has lost them.
#[test]
fn meshes_keep_the_coordinates_of_surveys() {
    let dir = scratch("survey_mesh");
    let corner = DVec3::new(512_000.3, 5_403_000.7, 430.2);
    let triangles = cuboid(corner, corner + DVec3::splat(0.3));
    let (mut obj, mut stl) = (String::new(), String::from("solid cube\n"));
    for triangle in &triangles {
        stl += "facet normal 0 0 0\n outer loop\n";
        for DVec3 { x, y, z } in triangle {
            obj += &format!("v {x} {y} {z}\n");
            stl += &format!("  vertex {x} {y} {z}\n");
        }
        obj += "f -3 -2 -1\n";
        stl += " endloop\nendfacet\n";
    }
    fs::write(dir.join("cube.obj"), obj).unwrap();
    fs::write(dir.join("cube.stl"), stl + "endsolid cube\n").unwrap();
    write_stl(&dir.join("binary.stl"), &triangles);
    let read = |name: &str| TriangleMesh::read(&dir.join(name), 1.0, (-corner).to_array());
    for name in ["cube.obj", "cube.stl"] {
        let mesh = read(name).unwrap();
        assert_eq!(mesh.vertices.len(), 8, "{name}");
        for vertex in &mesh.vertices {
            let nearest = (vertex / 0.3).round().clamp(DVec3::ZERO, DVec3::ONE) * 0.3;
            assert!(vertex.distance(nearest) < 1e-7, "{name} {vertex}");
        }
    }
    refused(
        read("binary.stl"),
        &["binary.stl", "32 bits", "export it as text"],
    );
}

#[test]
fn open_meshes_are_refused_with_the_hole() {
    let dir = scratch("open_mesh");
    let mut triangles = cuboid(DVec3::splat(2.0), DVec3::splat(6.0));
    triangles.truncate(11);
    write_stl(&dir.join("open.stl"), &triangles);
    let mesh = "[[solids]]\nkind = \"mesh\"\nfile = \"open.stl\"\nscale = 1e-3\n";
    // The missing triangle spans corners of the face z = 6 mm.
    refused(
        cube("open_mesh", 8, mesh).unwrap().solid_mask(),
        &[
            "open.stl",
            "3 boundary edges",
            "0.006000) m",
            "close its holes",
        ],
    );
    let mut turned = cuboid(DVec3::splat(2.0), DVec3::splat(6.0));
    turned[11].swap(0, 1);
    write_stl(&dir.join("open.stl"), &turned);
    refused(
        cube("open_mesh", 8, mesh).unwrap().solid_mask(),
        &["open.stl", "3 edges", "different ways", "recompute"],
    );
}

#[test]
fn meshes_elsewhere_or_unreadable_are_refused() {
    let dir = scratch("bad_mesh");
    write_stl(
        &dir.join("far.stl"),
        &cuboid(DVec3::splat(2.0), DVec3::splat(6.0)),
    );
    fs::write(dir.join("noise.stl"), "solid nonsense\nfacet").unwrap();
    fs::write(dir.join("noise.obj"), "v 1 2\nf 1 2 3\n").unwrap();
    fs::write(dir.join("rock.ply"), "ply").unwrap();
    let mask = |file: &str| {
        let mesh = format!("[[solids]]\nkind = \"mesh\"\nfile = \"{file}\"\n");
        cube("bad_mesh", 8, &mesh).unwrap().solid_mask()
    };
    refused(
        mask("far.stl"),
        &[
            "solids[0]",
            "far.stl",
            "wholly outside the domain",
            "(2, 2, 2)",
        ],
    );
    refused(mask("none.stl"), &["none.stl", "check the path"]);
    refused(mask("noise.stl"), &["noise.stl", "STL"]);
    refused(mask("noise.obj"), &["noise.obj", "OBJ"]);
    refused(mask("rock.ply"), &["rock.ply", ".stl or an .obj"]);
}

#[test]
fn a_million_cells_and_ten_thousand_triangles() {
    let dir = scratch("large_mesh");
    write_stl(&dir.join("ball.stl"), &ball(DVec3::splat(50.0), 40.0, 52));
    let mesh = "[[solids]]\nkind = \"mesh\"\nfile = \"ball.stl\"\nscale = 1e-3\n";
    let scene = cube("large_mesh", 100, mesh).unwrap();
    let volume = scene.solid_mask().unwrap().solid_count() as f64;
    // The inscribed polyhedron lacks about 2/3·(π/52)² of the sphere.
    assert!(
        (volume / (4.0 / 3.0 * std::f64::consts::PI * 64e3) - 1.0).abs() < 4e-3,
        "{volume}"
    );
}

#[test]
fn a_mask_has_no_cells_outside_of_its_grid() {
    let mut mask = Mask::new([2, 3, 4]).unwrap();
    for outside in [[2, 0, 0], [0, 3, 0], [0, 0, 4]] {
        mask.set(outside, true);
        assert!(!mask.is_solid(outside));
    }
    assert_eq!(mask.solid_count(), 0);
    mask.set([1, 2, 3], true);
    assert!(mask.is_solid([1, 2, 3]));
    let told = Mask::new([u32::MAX; 3]).unwrap_err().to_string();
    assert!(told.contains("domain.cell"), "{told}");
}

/// The log law of rough walls requires a roughness below a number of cells.
#[test]
fn roughness_of_walls_and_solids_has_a_bound() {
    let setup = |face: f64, solid: f64| {
        let scene = channel(&format!(
            "
            [numerics]
            eddy_viscosity = \"wale\"
            wall_model = \"reichardt\"
            velocity_scale = 1
            [boundaries]
            y_min = {{ kind = \"wall\", roughness = {face} }}
            y_max = {{ kind = \"wall\" }}
            [[solids]]
            kind = \"box\"
            min = [0, 0, 0]
            max = [2e-3, 2e-3, 2e-3]
            roughness = {solid}
            "
        ))
        .unwrap();
        let units = Units::of(&scene).unwrap();
        (lattice_setup(&scene, &units, None), units.cell)
    };
    let (made, cell) = setup(2e-4, 1e-4);
    let made = made.unwrap();
    assert_near(made.wall_roughness[1][0], 2e-4 / cell, 1e-12);
    assert_eq!(made.wall_roughness[1][1], 0.0);
    let rough = made.solid_roughness.iter().filter(|k| **k > 0.0).count();
    assert_eq!(rough, made.solid.iter().filter(|solid| **solid).count());
    for (face, solid, key) in [
        (1.0, 0.0, "boundaries.y_min.roughness"),
        (0.0, 1.0, "solids[0].roughness"),
    ] {
        let refused = setup(face, solid).0.unwrap_err().to_string();
        assert!(
            refused.contains(key) && refused.contains("5 cells"),
            "{refused}"
        );
    }
}

#[test]
fn a_channel_that_solids_close_is_refused() {
    let with_gate = |top: f64| {
        let scene = channel(&format!(
            r#"
            [boundaries]
            x_min = {{ kind = "velocity", velocity = [0.1, 0, 0] }}
            x_max = {{ kind = "pressure" }}
            [[solids]]
            kind = "box"
            min = [0.008, 0, 0]
            max = [0.01, 0.01, {top}]
            "#
        ))?;
        lattice_setup(&scene, &Units::of(&scene)?, None)
    };
    assert!(with_gate(0.003).is_ok());
    refused(with_gate(0.004), &["boundaries.x_min", "close"]);
}
