//! Input that bounds no block is refused with a message that names the face and a remedy.

use glam::DVec3;
use riprap::geometry::{Form, HalfSpace, Part, Polyhedron, RockMass, Shape, TriangleMesh};

fn cube() -> Vec<HalfSpace> {
    Polyhedron::cuboid(DVec3::ONE).unwrap().faces().to_vec()
}

/// The message of a refusal, in one line.
fn refusal<T: std::fmt::Debug>(made: riprap::Result<T>) -> String {
    made.expect_err("it must be refused").to_string() + "\n"
}

fn half_spaces(faces: &[HalfSpace]) -> String {
    refusal(Polyhedron::from_half_spaces(faces))
}

fn vertices(points: &[DVec3]) -> String {
    refusal(Polyhedron::from_vertices(points))
}

/// Unbounded for any distances; empty; all planes through one point.
#[test]
fn half_spaces_that_bound_no_block() {
    let mut open = cube();
    open.remove(3);
    let mut told = half_spaces(&open) + &half_spaces(&[]);
    open.iter_mut().for_each(|f| f.distance = -1.0);
    told += &half_spaces(&open);
    let mut empty = cube();
    empty[3].distance = -0.6;
    told += &half_spaces(&empty);
    empty.iter_mut().for_each(|f| f.distance = 0.0);
    told += &half_spaces(&empty);
    insta::assert_snapshot!(told);
}

#[test]
fn slivers() {
    let mut faces = cube();
    let plane = HalfSpace::through(DVec3::new(-0.4999, 0.0, 0.0), DVec3::X);
    faces.insert(2, plane);
    let mut told = half_spaces(&faces);
    faces[2].distance = -0.4996;
    assert!(Polyhedron::from_half_spaces(&faces).is_ok());
    told += &refusal(Polyhedron::cuboid(DVec3::new(1.0, 1e-5, 1.0)));
    let thin = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.3, 0.3, 1e-5)];
    told += &vertices(&thin);
    insta::assert_snapshot!(told);
}

#[test]
fn numbers_that_are_none() {
    let mut told = String::new();
    for bad in [f64::NAN, f64::INFINITY] {
        let mut faces = cube();
        faces[4].distance = bad;
        told += &half_spaces(&faces);
        let mut faces = cube();
        faces[5].normal.y = bad;
        told += &half_spaces(&faces);
    }
    let mut faces = cube();
    faces[1].normal = DVec3::ZERO;
    told += &half_spaces(&faces);
    told += &vertices(&[DVec3::X, DVec3::NAN]);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        told += &refusal(Polyhedron::cuboid(DVec3::new(1.0, bad, 1.0)));
        told += &refusal(Polyhedron::icosahedron(bad));
        told += &refusal(Shape::sphere(bad));
    }
    told += &refusal(Shape::compound(Vec::new()));
    told += &refusal(Shape::compound(vec![ball(1.0, 0.0), ball(1.0, f64::NAN)]));
    told += &refusal(Shape::compound(vec![ball(1.0, 0.0), ball(-1.0, 3.0)]));
    for bad in [f64::NAN, -1.0, f64::INFINITY] {
        let cut = |volume, thickness| {
            let mut mass = RockMass::new(vec![cube()]);
            (mass.smallest_volume, mass.smallest_thickness) = (volume, thickness);
            mass.cut()
        };
        told += &refusal(cut(bad, 0.0));
        told += &refusal(cut(0.0, bad));
    }
    insta::assert_snapshot!(told);
}

/// In a plane, in a point, and nearer to each other than f64 resolves.
#[test]
fn points_that_span_no_block() {
    let plane = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.3, 0.3, 1e-8)];
    let mut told: String = (0..=4).map(|n| vertices(&plane[..n])).collect();
    told += &vertices(&[DVec3::ONE; 5]);
    let tiny = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|x| x * 1e-120);
    told += &vertices(&tiny);
    insta::assert_snapshot!(told);
}

fn ball(radius: f64, x: f64) -> Part {
    Part {
        form: Form::Sphere { radius },
        offset: DVec3::new(x, 0.0, 0.0),
    }
}

#[test]
fn parts_that_overlap() {
    let cube = |x: f64, turn: f64| {
        let turn = glam::DQuat::from_rotation_z(turn);
        let cube = Polyhedron::cuboid(DVec3::ONE).unwrap();
        let points: Vec<DVec3> = cube.vertices().iter().map(|v| turn * *v).collect();
        let (polyhedron, _) = Polyhedron::from_vertices(&points).unwrap();
        Part {
            form: Form::Convex(polyhedron),
            offset: DVec3::new(x, 0.3, 0.2),
        }
    };
    // Half an edge, half a diagonal, and the distance of the ball's centre line from the cube, 0.
    let (flat, corner) = (0.5, 0.5_f64.sqrt());
    let quarter = std::f64::consts::FRAC_PI_4;
    let touching = [
        ([cube(0.0, 0.0), cube(1.0, 0.0)], 2.0 * flat),
        (
            [cube(0.0, 0.0), cube(flat + corner, quarter)],
            flat + corner,
        ),
        ([ball(0.5, 0.0), ball(0.25, 0.75)], 0.75),
        ([cube(0.0, 0.0), ball(0.4, 0.9)], 0.9),
        ([ball(0.4, 0.9), cube(0.0, 0.0)], -0.9),
        // The edge is 0.3 to the side of the ball's centre.
        ([cube(0.0, quarter), ball(0.5, corner + 0.4)], corner + 0.4),
    ];
    let mut told = String::new();
    for (parts, gap) in touching {
        assert!(Shape::compound(parts.to_vec()).is_ok(), "touching at {gap}");
        let mut closer = parts.to_vec();
        closer[1].offset.x -= 1e-3 * gap.signum();
        told += &refusal(Shape::compound(closer));
        let mut same = parts.to_vec();
        same[1].offset = same[0].offset;
        told += &refusal(Shape::compound(same));
    }
    insta::assert_snapshot!(told);
}

#[test]
fn triangles_of_vertices_that_are_not_there() {
    let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let mut told = refusal(TriangleMesh::new(&vertices, &[[0, 1, 3]]));
    let mesh = TriangleMesh {
        vertices,
        triangles: vec![[0, 1, 3]],
    };
    told += &refusal(Shape::from_mesh(&mesh));
    insta::assert_snapshot!(told);
    assert!(mesh.closed().is_err());
    assert!(mesh.corners(0)[2].is_nan() && mesh.corners(7)[0].is_nan());
}
