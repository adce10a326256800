//! Volumes and inertia of boxes, tetrahedra, regular solids and spheres against their closed forms.

use crate::measure::{assert_sound, difference};
use glam::{DMat3, DVec3};
use kit::assert_near;
use riprap::geometry::{Form, Part, Polyhedron, Shape};
use std::f64::consts::PI;

/// Sums of a few dozen terms in f64.
const EXACT: f64 = 4e-15;

#[test]
fn a_box_has_its_closed_forms() {
    let e = DVec3::new(1.0, 2.0, 3.0);
    let block = Polyhedron::cuboid(e).unwrap();
    assert_sound(&block);
    assert_eq!(
        (
            block.vertices().len(),
            block.edges().len(),
            block.faces().len()
        ),
        (8, 12, 6)
    );
    let volume = 6.0;
    let s = e * e * (volume / 12.0);
    let inertia = DMat3::from_diagonal(DVec3::new(s.y + s.z, s.z + s.x, s.x + s.y));
    assert_near(block.volume(), volume, EXACT * volume);
    assert!(difference(block.inertia(), inertia) < EXACT * 10.0);
    assert_eq!(block.smallest_distance(), 0.5);
    assert_near(block.radius(), e.length() / 2.0, EXACT);
}

#[test]
fn regular_solids_have_their_closed_forms() {
    let a = 0.37;
    let root = f64::sqrt;
    let phi = (1.0 + root(5.0)) / 2.0;
    // Volume / a³, inertia / (V a²), circumradius / a, inradius / a, faces, vertices.
    type Case = (
        fn(f64) -> riprap::Result<Polyhedron>,
        f64,
        f64,
        f64,
        f64,
        usize,
        usize,
    );
    let cases: [Case; 4] = [
        (
            Polyhedron::tetrahedron,
            1.0 / (6.0 * root(2.0)),
            1.0 / 20.0,
            root(6.0) / 4.0,
            root(6.0) / 12.0,
            4,
            4,
        ),
        (
            Polyhedron::octahedron,
            root(2.0) / 3.0,
            1.0 / 10.0,
            root(0.5),
            root(6.0) / 6.0,
            8,
            6,
        ),
        (
            Polyhedron::dodecahedron,
            (15.0 + 7.0 * root(5.0)) / 4.0,
            (39.0 * phi + 28.0) / 150.0,
            root(3.0) * phi / 2.0,
            phi * phi / (2.0 * root(3.0 - phi)),
            12,
            20,
        ),
        (
            Polyhedron::icosahedron,
            5.0 * (3.0 + root(5.0)) / 12.0,
            phi * phi / 10.0,
            root(phi * root(5.0)) / 2.0,
            phi * phi / (2.0 * root(3.0)),
            20,
            12,
        ),
    ];
    for (make, volume, inertia, outer, inner, faces, vertices) in cases {
        let solid = make(a).unwrap();
        assert_sound(&solid);
        assert_eq!(
            (solid.faces().len(), solid.vertices().len()),
            (faces, vertices)
        );
        let v = volume * a.powi(3);
        assert!(
            (solid.volume() - v).abs() < 4.0 * EXACT * v,
            "{faces} faces"
        );
        let i = inertia * v * a * a;
        let tensor = DMat3::from_diagonal(DVec3::splat(i));
        assert!(
            difference(solid.inertia(), tensor) < 4.0 * EXACT * i,
            "{faces} faces"
        );
        assert_near(solid.radius(), outer * a, 4.0 * EXACT * a);
        assert_near(solid.smallest_distance(), inner * a, 4.0 * EXACT * a);
        for [p, q] in solid.edges() {
            let length = solid.vertices()[*p as usize].distance(solid.vertices()[*q as usize]);
            assert_near(length, a, 4.0 * EXACT * a);
        }
    }
}

#[test]
fn any_tetrahedron_has_its_closed_forms() {
    let corners = [
        DVec3::new(8.3, -5.2, 1.9),
        DVec3::new(9.1, -4.0, 2.0),
        DVec3::new(7.2, -4.5, 3.4),
        DVec3::new(8.8, -6.1, 4.2),
    ];
    let (solid, centre) = Polyhedron::from_vertices(&corners).unwrap();
    assert_sound(&solid);
    let mean = corners.iter().sum::<DVec3>() / 4.0;
    assert!(centre.distance(mean) < EXACT * 10.0);
    let r = corners.map(|c| c - mean);
    let volume = (r[1] - r[0]).dot((r[2] - r[0]).cross(r[3] - r[0])).abs() / 6.0;
    assert_near(solid.volume(), volume, 4.0 * EXACT * volume);
    // ∫x xᵀ dV = V/20 Σ r rᵀ about the centroid (Tonon 2004).
    let square = r.iter().fold(DMat3::ZERO, |s, r| {
        s + DMat3::from_cols(*r * r.x, *r * r.y, *r * r.z)
    }) * (volume / 20.0);
    let trace = square.x_axis.x + square.y_axis.y + square.z_axis.z;
    let inertia = DMat3::IDENTITY * trace - square;
    assert!(difference(solid.inertia(), inertia) < 10.0 * EXACT * trace);
}

#[test]
fn a_sphere_has_its_closed_forms() {
    let ball = Shape::sphere(0.3).unwrap();
    let volume = 4.0 / 3.0 * PI * 0.027;
    assert_near(ball.volume(), volume, EXACT * volume);
    let inertia = DMat3::from_diagonal(DVec3::splat(0.4 * volume * 0.09));
    assert!(difference(ball.inertia(), inertia) < EXACT * volume);
    assert_eq!((ball.radius(), ball.parts().len()), (0.3, 1));
}

#[test]
fn two_boxes_make_the_box_that_they_fill() {
    let half = Polyhedron::cuboid(DVec3::new(1.0, 1.0, 1.5)).unwrap();
    let at = |z| Part {
        form: Form::Convex(half.clone()),
        offset: DVec3::new(5.0, -2.0, z),
    };
    let (shape, centre) = Shape::compound(vec![at(0.75), at(2.25)]).unwrap();
    let whole = Polyhedron::cuboid(DVec3::new(1.0, 1.0, 3.0)).unwrap();
    assert!(centre.distance(DVec3::new(5.0, -2.0, 1.5)) < EXACT * 10.0);
    assert_near(shape.volume(), 3.0, EXACT * 3.0);
    assert!(difference(shape.inertia(), whole.inertia()) < EXACT * 10.0);
    assert_near(shape.radius(), whole.radius(), EXACT);
    assert_eq!(shape.parts()[0].offset.z, -0.75);
}
