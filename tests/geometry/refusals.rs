//! What is no block is refused, and the message says which face and what to do.

use glam::DVec3;
use riprap::geometry::{Form, HalfSpace, Part, Polyhedron, RockMass, Shape, TriangleMesh};

fn cube() -> Vec<HalfSpace> {
    Polyhedron::cuboid(DVec3::ONE).unwrap().faces().to_vec()
}

fn refused<T: std::fmt::Debug>(made: riprap::Result<T>, words: &[&str]) {
    let message = made.unwrap_err().to_string();
    for word in words {
        assert!(message.contains(word), "'{word}' is not in: {message}");
    }
}

#[test]
fn unbounded() {
    let mut open = cube();
    open.remove(3);
    refused(
        Polyhedron::from_half_spaces(&open),
        &[
            "faces: 5 faces",
            "unbounded towards (",
            "1.000,",
            "add a face",
        ],
    );
    refused(Polyhedron::from_half_spaces(&[]), &["0 faces", "unbounded"]);
    // Whatever the distances, also if nothing is left.
    open.iter_mut().for_each(|f| f.distance = -1.0);
    refused(Polyhedron::from_half_spaces(&open), &["unbounded"]);
}

#[test]
fn empty() {
    let mut faces = cube();
    faces[3].distance = -0.6;
    refused(
        Polyhedron::from_half_spaces(&faces),
        &["faces[3]", "nothing is left", "signs"],
    );
    // All planes through one point.
    faces.iter_mut().for_each(|f| f.distance = 0.0);
    refused(Polyhedron::from_half_spaces(&faces), &["faces"]);
}

#[test]
fn sliver() {
    let mut faces = cube();
    faces.insert(
        2,
        HalfSpace::through(DVec3::new(-0.4999, 0.0, 0.0), DVec3::X),
    );
    refused(
        Polyhedron::from_half_spaces(&faces),
        &[
            "faces[0]",
            "5.000e-5 m from the centroid",
            "1/10000",
            "thicker",
        ],
    );
    faces[2].distance = -0.4996;
    assert!(Polyhedron::from_half_spaces(&faces).is_ok());
    refused(
        Polyhedron::cuboid(DVec3::new(1.0, 1e-5, 1.0)),
        &["faces[2]", "thicker"],
    );
}

#[test]
fn not_finite() {
    for bad in [f64::NAN, f64::INFINITY] {
        let mut faces = cube();
        faces[4].distance = bad;
        refused(
            Polyhedron::from_half_spaces(&faces),
            &["faces[4]", "finite"],
        );
        let mut faces = cube();
        faces[5].normal.y = bad;
        refused(
            Polyhedron::from_half_spaces(&faces),
            &["faces[5]", "finite"],
        );
    }
    let mut faces = cube();
    faces[1].normal = DVec3::ZERO;
    refused(
        Polyhedron::from_half_spaces(&faces),
        &["faces[1]", "not zero"],
    );
    let points = [DVec3::X, DVec3::NAN];
    refused(
        Polyhedron::from_vertices(&points),
        &["vertices[1]", "finite"],
    );
}

#[test]
fn flat_points() {
    let plane = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.3, 0.3, 1e-8)];
    for points in [
        &plane[..0],
        &plane[..1],
        &plane[..2],
        &plane[..3],
        &plane[..],
    ] {
        refused(
            Polyhedron::from_vertices(points),
            &["vertices", "thickness"],
        );
    }
    refused(Polyhedron::from_vertices(&[DVec3::ONE; 5]), &["thickness"]);
    let thin = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.3, 0.3, 1e-5)];
    refused(Polyhedron::from_vertices(&thin), &["faces[", "thicker"]);
}

#[test]
fn no_lengths() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        refused(
            Polyhedron::cuboid(DVec3::new(1.0, bad, 1.0)),
            &["edges[1]", "positive"],
        );
        refused(Polyhedron::icosahedron(bad), &["edge", "positive"]);
        refused(Shape::sphere(bad), &["radius", "positive"]);
    }
}

fn ball(radius: f64, x: f64) -> Part {
    Part {
        form: Form::Sphere { radius },
        offset: DVec3::new(x, 0.0, 0.0),
    }
}

#[test]
fn no_compound() {
    refused(Shape::compound(Vec::new()), &["parts", "at least one"]);
    let compound = Shape::compound(vec![ball(1.0, 0.0), ball(1.0, f64::NAN)]);
    refused(compound, &["parts[1].offset", "finite"]);
    let compound = Shape::compound(vec![ball(1.0, 0.0), ball(-1.0, 3.0)]);
    refused(compound, &["parts[1].radius", "positive"]);
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
    for (parts, gap) in touching {
        assert!(Shape::compound(parts.to_vec()).is_ok(), "touching at {gap}");
        let mut closer = parts.to_vec();
        closer[1].offset.x -= 1e-3 * gap.signum();
        refused(
            Shape::compound(closer),
            &["parts[1]", "overlaps parts[0]", "twice"],
        );
        let mut same = parts.to_vec();
        same[1].offset = same[0].offset;
        refused(Shape::compound(same), &["overlaps"]);
    }
}

#[test]
fn points_too_near_to_compute_with() {
    let tiny = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|x| x * 1e-120);
    refused(Polyhedron::from_vertices(&tiny), &["vertices", "unit"]);
}

#[test]
fn triangles_of_vertices_that_are_not_there() {
    let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let words = ["vertex 3", "only 3"];
    refused(TriangleMesh::new(&vertices, &[[0, 1, 3]]), &words);
    let mesh = TriangleMesh {
        vertices,
        triangles: vec![[0, 1, 3]],
    };
    refused(Shape::from_mesh(&mesh), &["not there"]);
    assert!(mesh.closed().is_err());
    assert!(mesh.corners(0)[2].is_nan() && mesh.corners(7)[0].is_nan());
}

#[test]
fn limits_for_slivers() {
    for bad in [f64::NAN, -1.0, f64::INFINITY] {
        let cut = |volume, thickness| {
            let mut mass = RockMass::new(vec![cube()]);
            (mass.smallest_volume, mass.smallest_thickness) = (volume, thickness);
            mass.cut()
        };
        refused(cut(bad, 0.0), &["smallest_volume"]);
        refused(cut(0.0, bad), &["smallest_thickness"]);
    }
}
