//! Random polyhedra: soundness, round trips, redundant and coplanar faces.

use crate::measure::{assert_sound, difference};
use glam::{DQuat, DVec3};
use kit::assert_near;
use proptest::prelude::*;
use riprap::geometry::{HalfSpace, Polyhedron};

fn direction() -> impl Strategy<Value = DVec3> {
    // Uniform on the sphere (Archimedes).
    (-1.0..1.0_f64, 0.0..std::f64::consts::TAU).prop_map(|(z, turn)| {
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * turn.cos(), r * turn.sin(), z).normalize()
    })
}

/// Tangent planes at random distances around a point, with a box around them all so that the intersection is bounded.
fn half_spaces() -> impl Strategy<Value = Vec<HalfSpace>> {
    let face =
        (direction(), 0.5..1.5_f64).prop_map(|(normal, distance)| HalfSpace { normal, distance });
    proptest::collection::vec(face, 0..40).prop_map(|mut faces| {
        for axis in DVec3::AXES {
            faces.push(HalfSpace::through(axis * 1.6, axis));
            faces.push(HalfSpace::through(axis * -1.6, -axis));
        }
        faces
    })
}

fn same_solid(a: &Polyhedron, b: &Polyhedron) -> bool {
    let close = |x: f64, y: f64| (x - y).abs() <= 1e-9 * x.abs();
    a.faces().len() == b.faces().len()
        && a.vertices().len() == b.vertices().len()
        && close(a.volume(), b.volume())
        && close(a.radius(), b.radius())
        && difference(a.inertia(), b.inertia()) <= 1e-9 * a.volume() * a.radius().powi(2)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn half_spaces_to_vertices_and_back_is_the_same_solid(
        faces in half_spaces(),
        shift in direction(),
        scale in -3.0..3.0_f64,
        far in 0.0..100.0_f64,
    ) {
        // At any position, in any unit.
        let unit = 10f64.powf(scale);
        let place = shift * (far * unit);
        let placed: Vec<HalfSpace> = faces
            .iter()
            .map(|f| HalfSpace::through(f.normal * f.distance * unit + place, f.normal))
            .collect();
        let (first, centre) = Polyhedron::from_half_spaces(&placed).unwrap();
        assert_sound(&first);
        let points: Vec<DVec3> = first.vertices().iter().map(|v| *v + centre).collect();
        let (second, again) = Polyhedron::from_vertices(&points).unwrap();
        assert_sound(&second);
        // Faces smaller than 1e-9 of the size count as flat in the hull; no case here has one by chance.
        prop_assert!(same_solid(&first, &second));
        prop_assert!(centre.distance(again) <= 1e-9 * unit);
        let (third, zero) = Polyhedron::from_half_spaces(second.faces()).unwrap();
        prop_assert!(same_solid(&first, &third));
        prop_assert!(zero.length() <= 1e-9 * unit);
    }

    #[test]
    fn the_order_of_faces_and_vertices_does_not_matter(faces in half_spaces(), turn in 0..40_usize) {
        let (first, centre) = Polyhedron::from_half_spaces(&faces).unwrap();
        let mut turned = faces.clone();
        turned.rotate_left(turn % faces.len());
        let (second, again) = Polyhedron::from_half_spaces(&turned).unwrap();
        prop_assert!(same_solid(&first, &second));
        prop_assert!(centre.distance(again) <= 1e-12);
    }

    #[test]
    fn a_hull_holds_all_points_and_drops_those_inside(
        points in proptest::collection::vec((direction(), 0.0..1.0_f64), 8..200),
    ) {
        let points: Vec<DVec3> = points.iter().map(|(d, r)| *d * r.sqrt()).collect();
        let Ok((hull, centre)) = Polyhedron::from_vertices(&points) else {
            // Eight points may be a sliver.
            return Ok(());
        };
        assert_sound(&hull);
        for p in &points {
            let height = |f: &HalfSpace| f.height(*p - centre);
            let outside = hull.faces().iter().map(height).fold(f64::NEG_INFINITY, f64::max);
            prop_assert!(outside <= 1e-14);
        }
        // Every vertex is one of the points.
        for v in hull.vertices() {
            let nearest = points.iter().map(|p| p.distance(*v + centre)).fold(1.0, f64::min);
            prop_assert!(nearest < 1e-8, "{nearest:e}");
        }
        // Inner points and duplicates change nothing.
        let mut more: Vec<DVec3> = points.iter().map(|p| p * 0.5 + centre * 0.5).collect();
        more.extend(&points);
        more.extend(&points);
        let (same, _) = Polyhedron::from_vertices(&more).unwrap();
        prop_assert!(same_solid(&hull, &same));
    }
}

#[test]
fn redundant_and_coplanar_faces_go_and_the_others_keep_their_order() {
    let cube = Polyhedron::cuboid(DVec3::ONE).unwrap();
    let turn = DQuat::from_rotation_y(0.3) * DQuat::from_rotation_x(1.1);
    let face = |normal: DVec3, distance: f64| HalfSpace {
        normal: turn * normal,
        distance,
    };
    let mut faces: Vec<HalfSpace> = cube
        .faces()
        .iter()
        .map(|f| face(f.normal, f.distance))
        .collect();
    // Away from it, through an edge, through a corner, a duplicate, a duplicate up to rounding.
    faces.insert(1, face(DVec3::new(1.0, 2.0, 0.0).normalize(), 3.0));
    faces.insert(
        2,
        face(DVec3::new(1.0, 1.0, 0.0).normalize(), 0.5 * 2f64.sqrt()),
    );
    faces.push(face(DVec3::ONE.normalize(), 0.5 * 3f64.sqrt()));
    faces.push(faces[0]);
    faces.push(face(DVec3::new(1.0, 1e-13, 0.0), 0.5));
    let (block, centre) = Polyhedron::from_half_spaces(&faces).unwrap();
    assert_sound(&block);
    assert_eq!(block.faces().len(), 6);
    assert!(centre.length() < 1e-15);
    let kept = [0, 3, 4, 5, 6, 7].map(|i| faces[i].normal);
    assert!(block.faces().iter().map(|f| f.normal).eq(kept));
}

#[test]
fn normals_of_any_length_give_the_same_block() {
    let cube = Polyhedron::cuboid(DVec3::new(1.0, 2.0, 3.0)).unwrap();
    let scaled = cube.faces().iter().enumerate().map(|(i, f)| HalfSpace {
        normal: f.normal * (2 << i) as f64,
        distance: f.distance * (2 << i) as f64,
    });
    let (block, _) = Polyhedron::from_half_spaces(&scaled.collect::<Vec<_>>()).unwrap();
    for (scaled, unit) in block.faces().iter().zip(cube.faces()) {
        assert_eq!(scaled.normal, unit.normal);
        assert_near(scaled.distance, unit.distance, 1e-15);
    }
}

#[test]
fn a_hull_with_many_vertices_on_a_sphere_is_right() {
    // Fibonacci's lattice: 1000 points, all of them vertices, so 1996 triangles.
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let points: Vec<DVec3> = (0..1000)
        .map(|i| {
            let z = 1.0 - (2 * i + 1) as f64 / 1000.0;
            let (sin, cos) = (golden * i as f64).sin_cos();
            let r = (1.0 - z * z).sqrt();
            DVec3::new(r * cos, r * sin, z)
        })
        .collect();
    let (hull, _) = Polyhedron::from_vertices(&points).unwrap();
    assert_sound(&hull);
    assert_eq!((hull.vertices().len(), hull.faces().len()), (1000, 1996));
}
