//! Blocks from meshes: convex, concave, and refused ones.

use crate::measure::{assert_sound, difference};
use glam::{DMat3, DQuat, DVec3};
use kit::{assert_near, assert_relative};
use riprap::geometry::TriangleMesh;
use riprap::geometry::{Form, Polyhedron, Shape};
use std::fmt::Write;
use std::path::PathBuf;

/// The faces of a polyhedron as triangles, transformed by `place`.
fn triangles(p: &Polyhedron, place: impl Fn(DVec3) -> DVec3) -> Vec<[DVec3; 3]> {
    let at = |v: u32| place(p.vertices()[v as usize]);
    let fans = p.loops().iter().flat_map(|ring| {
        let pairs = ring[1..].windows(2);
        pairs.map(|pair| [at(ring[0]), at(pair[0]), at(pair[1])])
    });
    fans.collect()
}

fn mesh(triangles: &[[DVec3; 3]]) -> TriangleMesh {
    let vertices = triangles.as_flattened();
    let corners: Vec<[u32; 3]> = (0..triangles.len() as u32)
        .map(|t| [3 * t, 3 * t + 1, 3 * t + 2])
        .collect();
    TriangleMesh::new(vertices, &corners).unwrap()
}

/// A prism over a polygon (counter-clockwise) cut into triangles, from z = 0 to `height`.
fn prism(outline: &[[f64; 2]], tops: &[[usize; 3]], height: f64) -> Vec<[DVec3; 3]> {
    let at = |i: usize, z: f64| DVec3::new(outline[i][0], outline[i][1], z);
    let mut all = Vec::new();
    for [a, b, c] in tops {
        all.push([at(*a, height), at(*b, height), at(*c, height)]);
        all.push([at(*a, 0.0), at(*c, 0.0), at(*b, 0.0)]);
    }
    for i in 0..outline.len() {
        let j = (i + 1) % outline.len();
        all.push([at(i, 0.0), at(j, 0.0), at(j, height)]);
        all.push([at(i, 0.0), at(j, height), at(i, height)]);
    }
    all
}

const L: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [3.0, 0.0],
    [3.0, 1.0],
    [1.0, 1.0],
    [1.0, 2.0],
    [0.0, 2.0],
];
const L_TOPS: [[usize; 3]; 4] = [[0, 1, 2], [0, 2, 3], [0, 3, 5], [3, 4, 5]];

fn file(name: &str, text: &str) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("block_{name}"));
    std::fs::write(&path, text).unwrap();
    path
}

fn stl(triangles: &[[DVec3; 3]]) -> String {
    let mut text = String::from("solid rock\n");
    for corners in triangles {
        text += "facet normal 0 0 0\nouter loop\n";
        for c in corners {
            writeln!(text, "vertex {} {} {}", c.x as f32, c.y as f32, c.z as f32).unwrap();
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid rock\n"
}

fn obj(mesh: &TriangleMesh) -> String {
    let mut text = String::new();
    for v in &mesh.vertices {
        writeln!(text, "v {} {} {}", v.x, v.y, v.z).unwrap();
    }
    for t in &mesh.triangles {
        writeln!(text, "f {} {} {}", t[0] + 1, t[1] + 1, t[2] + 1).unwrap();
    }
    text
}

fn convex(shape: &Shape) -> Vec<(&Polyhedron, DVec3)> {
    let parts = shape.parts().iter().map(|part| match &part.form {
        Form::Convex(p) => (p, part.offset),
        Form::Sphere { .. } => panic!("a mesh has no spheres"),
    });
    parts.collect()
}

/// Capitals, no name, a byte order mark, normals that are no numbers, and lines of OBJ that go on.
#[test]
fn text_meshes_of_other_programs_are_read() {
    let all = triangles(&Polyhedron::cuboid(DVec3::ONE).unwrap(), |v| v);
    let (stl, obj) = (stl(&all), obj(&mesh(&all)));
    let nameless = stl.replace("solid rock", "solid");
    let variants = [
        ("capitals.stl", stl.to_uppercase()),
        ("mark.stl", format!("\u{feff}{stl}")),
        (
            "normals.stl",
            stl.replace("normal 0 0 0", "normal nan -nan NaN"),
        ),
        ("windows.stl", nameless.replace('\n', "\r\n")),
        ("nameless.stl", nameless),
        ("mark.obj", format!("\u{feff}{obj}")),
        ("long.obj", obj.replace("f 1 ", "f \\\n1 ")),
    ];
    for (name, text) in variants {
        let (shape, _) = Shape::read(&file(name, &text), 1.0).expect(name);
        assert_relative(shape.volume(), 1.0, 1e-6);
    }
}

#[test]
fn a_convex_mesh_is_one_polyhedron_with_its_faces_merged() {
    let solid = Polyhedron::dodecahedron(0.2).unwrap();
    let turn = DQuat::from_rotation_x(0.7) * DQuat::from_rotation_z(0.4);
    let all = triangles(&solid, |v| {
        turn * v * 1000.0 + DVec3::new(300.0, 50.0, -20.0)
    });
    let (shape, centre) = Shape::read(&file("dodecahedron.stl", &stl(&all)), 1e-3).unwrap();
    let parts = convex(&shape);
    assert_eq!((parts.len(), parts[0].0.faces().len()), (1, 12));
    assert_sound(parts[0].0);
    // f32 of 0.6 m has an error of 4e-8 m, in a block of 0.55 m.
    assert_relative(shape.volume(), solid.volume(), 1e-6);
    assert!(centre.distance(DVec3::new(0.3, 0.05, -0.02)) < 1e-7);
    assert!(difference(shape.inertia(), solid.inertia()) < 1e-6 * solid.inertia().x_axis.x);
    let (shape, _) = Shape::read(&file("dodecahedron.obj", &obj(&mesh(&all))), 1e-3).unwrap();
    assert_relative(shape.volume(), solid.volume(), 1e-6);
    assert_eq!(convex(&shape)[0].0.vertices().len(), 20);
}

#[test]
fn an_l_is_two_boxes_with_exact_mass() {
    let all = prism(&L, &L_TOPS, 1.0);
    let (shape, centre) = Shape::read(&file("l.stl", &stl(&all)), 1.0).unwrap();
    let parts = convex(&shape);
    assert_eq!(parts.len(), 2);
    for (part, _) in &parts {
        assert_sound(part);
        assert_eq!(part.faces().len(), 6);
    }
    let sum: f64 = parts.iter().map(|(p, _)| p.volume()).sum();
    assert!((sum - 4.0).abs() < 1e-12 && (shape.volume() - 4.0).abs() < 1e-14);
    // Boxes 3 × 1 at (1.5, 0.5) and 1 × 1 at (0.5, 1.5).
    let exact = DVec3::new((3.0 * 1.5 + 0.5) / 4.0, (3.0 * 0.5 + 1.5) / 4.0, 0.5);
    assert!(centre.distance(exact) < 1e-14);
    let bar = |e: DVec3, at: DVec3| {
        let m = e.x * e.y * e.z;
        let s = e * e / 12.0 * m;
        let r = at - exact;
        let square = DMat3::from_cols(r * r.x, r * r.y, r * r.z);
        DMat3::from_diagonal(DVec3::new(s.y + s.z, s.z + s.x, s.x + s.y))
            + (DMat3::IDENTITY * r.length_squared() - square) * m
    };
    let inertia = bar(DVec3::new(3.0, 1.0, 1.0), DVec3::new(1.5, 0.5, 0.5))
        + bar(DVec3::ONE, DVec3::new(0.5, 1.5, 0.5));
    assert!(difference(shape.inertia(), inertia) < 1e-13);
    let reach = DVec3::new(3.0, 0.0, 0.0) - exact;
    assert_near(shape.radius(), reach.length(), 1e-9);
}

/// Number of parts that a point (m, relative to the centroid) is inside of.
fn inside(parts: &[(&Polyhedron, DVec3)], at: DVec3) -> usize {
    let holds = |(p, offset): &&(&Polyhedron, DVec3)| {
        p.faces().iter().all(|f| f.height(at - *offset) <= 0.0)
    };
    parts.iter().filter(holds).count()
}

#[test]
fn parts_of_a_turned_star_fill_it_once() {
    // A four-pointed star: four concave edges, no plane along the axes.
    let ring: Vec<[f64; 2]> = (0..8)
        .map(|i| {
            let (sin, cos) = (f64::from(i) * std::f64::consts::FRAC_PI_4).sin_cos();
            let r = if i % 2 == 0 { 2.0 } else { 0.7 };
            [r * cos, r * sin]
        })
        .collect();
    let tops = [
        [0, 1, 7],
        [1, 2, 3],
        [3, 4, 5],
        [5, 6, 7],
        [1, 3, 5],
        [1, 5, 7],
    ];
    let turn = DQuat::from_rotation_y(0.5) * DQuat::from_rotation_x(1.0);
    let all: Vec<[DVec3; 3]> = prism(&ring, &tops, 0.8)
        .iter()
        .map(|t| t.map(|c| turn * c))
        .collect();
    let (shape, centre) = Shape::read(&file("star.stl", &stl(&all)), 1.0).unwrap();
    let parts = convex(&shape);
    // Half of r R sin 45° eight times.
    let volume = 0.8 * 4.0 * 2.0 * 0.7 * 0.5_f64.sqrt();
    assert_relative(shape.volume(), volume, 1e-6);
    assert!((3..=8).contains(&parts.len()), "{} parts", parts.len());
    let sum: f64 = parts.iter().map(|(p, _)| p.volume()).sum();
    assert_relative(sum, volume, 1e-5);
    for (part, _) in &parts {
        assert_sound(part);
    }
    // Every point of a grid is in one part if the star contains it, else in none.
    let (mut held, mut total) = (0, 0);
    for n in 0..40_i32.pow(3) {
        let at = [n % 40, n / 40 % 40, n / 1600].map(|k| (f64::from(k) - 19.37) / 19.0 * 2.0);
        let at = DVec3::from(at);
        let flat = turn.inverse() * (at + centre);
        let sector = flat.y.atan2(flat.x).rem_euclid(std::f64::consts::FRAC_PI_2);
        let folded = if sector > std::f64::consts::FRAC_PI_4 {
            std::f64::consts::FRAC_PI_2 - sector
        } else {
            sector
        };
        // In the triangle 0, 2 along x, 0.7 along the diagonal.
        let r = flat.x.hypot(flat.y);
        let (x, y) = (r * folded.cos(), r * folded.sin());
        let half = 0.7 * 0.5_f64.sqrt();
        let side = half * (2.0 - x) - (2.0 - half) * y;
        if side.abs() < 1e-4 || flat.z.abs() < 1e-4 || (flat.z - 0.8).abs() < 1e-4 {
            continue;
        }
        let star = side > 0.0 && (0.0..=0.8).contains(&flat.z);
        let count = inside(&parts, at);
        // On a common face of two parts, a point may be in both.
        assert!(
            if star { count >= 1 } else { count == 0 },
            "{at} is in {count} parts"
        );
        held += count;
        total += usize::from(star);
    }
    assert!(total > 1000 && held <= total + total / 1000);
}

#[test]
fn a_box_with_a_hole_through_it_or_inside_it_is_a_compound() {
    let cube = Polyhedron::cuboid(DVec3::splat(2.0)).unwrap();
    let hole = Polyhedron::cuboid(DVec3::splat(1.0)).unwrap();
    let mut all = triangles(&cube, |v| v);
    all.extend(triangles(&hole, |v| v).iter().map(|[a, b, c]| [*a, *c, *b]));
    let (shape, centre) = Shape::from_mesh(&mesh(&all)).unwrap();
    assert!((shape.volume() - 7.0).abs() < 1e-13 && centre.length() < 1e-13);
    let inertia = cube.inertia() - hole.inertia();
    assert!(difference(shape.inertia(), inertia) < 1e-13);
    let parts = convex(&shape);
    assert_eq!(parts.len(), 6);
    assert_eq!(inside(&parts, DVec3::new(0.1, 0.2, 0.3)), 0);
    assert_eq!(inside(&parts, DVec3::new(0.8, 0.2, 0.3)), 1);
}

/// A torus: every inner edge is concave.
fn torus(around: u32, tube: u32) -> TriangleMesh {
    let at = |i: u32, j: u32| {
        let turn =
            |k: u32, n: u32| (f64::from(k % n) / f64::from(n) * std::f64::consts::TAU).sin_cos();
        let ((s, c), (t, d)) = (turn(i, around), turn(j, tube));
        let r = 1.0 + 0.4 * d;
        DVec3::new(r * c, r * s, 0.4 * t)
    };
    let mut all = Vec::new();
    for i in 0..around {
        for j in 0..tube {
            all.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            all.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    mesh(&all)
}

#[test]
fn a_solid_with_many_concave_edges_has_parts_near_it_and_exact_mass() {
    let (shape, centre) = Shape::from_mesh(&torus(60, 40)).unwrap();
    // V = 2π² R r² less the part that the chords cut off: 1 − (2π/n)²/6 around each circle.
    let smooth = 2.0 * std::f64::consts::PI.powi(2) * 0.16;
    let chords = |n: f64| 1.0 - (std::f64::consts::TAU / n).powi(2) / 6.0;
    let ratio = shape.volume() / (smooth * chords(60.0) * chords(40.0));
    assert_near(ratio, 1.0, 2e-3);
    assert!(centre.length() < 1e-13);
    let parts = convex(&shape);
    assert!(parts.len() > 8, "{} parts", parts.len());
    assert_eq!(inside(&parts, DVec3::ZERO), 0);
    assert!(inside(&parts, DVec3::X) >= 1);
    let sum: f64 = parts.iter().map(|(p, _)| p.volume()).sum();
    // Each part contains all of the solid in its cell, and protrudes slightly.
    assert!((0.0..0.01).contains(&(sum / shape.volume() - 1.0)));
}

#[test]
fn what_is_no_solid_is_refused() {
    let cube = Polyhedron::cuboid(DVec3::ONE).unwrap();
    let all = triangles(&cube, |v| v);
    let turned = |triangles: &[[DVec3; 3]]| -> Vec<[DVec3; 3]> {
        triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect()
    };
    let mut one_turned = all.clone();
    one_turned[0].swap(0, 1);
    let sheet = vec![
        [DVec3::ZERO, DVec3::X, DVec3::Y],
        [DVec3::ZERO, DVec3::Y, DVec3::X],
    ];
    let thin = triangles(&cube, |v| v * DVec3::new(1.0, 1.0, 5e-5));
    // Two boxes next to each other, one inside out.
    let beside = triangles(&cube, |v| v * 0.9 + DVec3::X * 5.0);
    let crossed = [all.clone(), turned(&beside)].concat();
    let mut told = String::new();
    for (name, triangles, scale) in [
        ("open", all[1..].to_vec(), 1.0),
        ("twice", [&all[..], &all[3..4]].concat(), 1.0),
        ("inverted", turned(&all), 1.0),
        ("one_turned", one_turned, 1.0),
        ("flat", sheet, 1.0),
        ("thin", thin, 1.0),
        ("scaled", all, -1.0),
        ("crossed", crossed, 1.0),
    ] {
        let path = file(&format!("{name}.stl"), &stl(&triangles));
        let error = Shape::read(&path, scale).unwrap_err().to_string();
        told += &(error.replace(env!("CARGO_TARGET_TMPDIR"), "") + "\n");
    }
    insta::assert_snapshot!(told);
}
