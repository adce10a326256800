//! Overlap, area, pressure centre and width against geometry in closed form.

use super::contact;
use glam::{DQuat, DVec3};
use kit::{
    assert_near,
    contact::{Random, Solid},
};
use std::f64::consts::{FRAC_PI_4, FRAC_PI_8, SQRT_2};

/// Two boxes, all edges parallel: the common rectangle.
#[test]
fn box_on_box_with_partial_overlap() {
    let (below, above) = (DVec3::new(2.0, 1.5, 1.0), DVec3::new(1.0, 1.0, 0.5));
    for u in [1e-11, 1e-7, 1e-4, 1e-2] {
        let a = Solid::cuboid(below).at(DVec3::ZERO, DQuat::IDENTITY);
        let centre = DVec3::new(0.8, -0.45, 0.75 - u);
        let b = Solid::cuboid(above).at(centre, DQuat::IDENTITY);
        let found = contact(&a, &b);
        // x from 0.3 to 1, y from −0.75 to 0.05.
        assert_near(found.area, 0.7 * 0.8, 1e-12);
        assert_near(found.overlap, u, 1e-14);
        assert_near(found.width, 0.7f64.hypot(0.8), 1e-12);
        let middle = DVec3::new(0.65, -0.35, 0.5 - 0.5 * u);
        assert!((found.pressure_centre - middle).length() < 1e-11);
        assert!((found.normal - DVec3::Z).length() < 1e-11);
        assert_near(found.limit, 0.025, 1e-15);
    }
}

/// A square on a square rotated by 45°: a regular octagon, 2(√2 − 1) of the square.
#[test]
fn turned_square_on_square() {
    let cube = Solid::cube();
    let a = cube.at(DVec3::ZERO, DQuat::IDENTITY);
    let b = cube.at(DVec3::Z * (1.0 - 1e-5), DQuat::from_rotation_z(FRAC_PI_4));
    let found = contact(&a, &b);
    assert_near(found.area, 2.0 * (SQRT_2 - 1.0), 1e-12);
    assert_near(found.width, 1.0 / FRAC_PI_8.cos(), 1e-12);
    assert_near(found.overlap, 1e-5, 1e-15);
    assert!(found.pressure_centre.truncate().length() < 1e-12);
}

/// Two edges that cross at right angles, between faces at 45°: |y| ≤ u/2 − z, |x| ≤ u/2 + z, in the
/// middle a square of side u.
#[test]
fn edge_across_edge() {
    let cube = Solid::cube();
    let half = 0.5 * SQRT_2;
    for u in [1e-6, 1e-4, 1e-3] {
        let a = cube.at(-DVec3::Z * half, DQuat::from_rotation_x(FRAC_PI_4));
        let b = cube.at(DVec3::Z * (half - u), DQuat::from_rotation_y(FRAC_PI_4));
        let found = contact(&a, &b);
        assert_near(found.overlap / u, 1.0, 1e-6);
        assert_near(found.area / (u * u), 1.0, 1e-5);
        assert_near(found.width / (u * SQRT_2), 1.0, 1e-5);
        let middle = -DVec3::Z * 0.5 * u;
        assert!((found.point - middle).length() < 1e-5 * u);
        assert!((found.pressure_centre - middle).length() < 1e-5 * u);
        assert!(found.normal.cross(DVec3::Z).length() < 1e-6);
    }
}

/// A cube's corner pressed into a face: the analytic centre of the small tetrahedron is its centroid,
/// a quarter of the depth from the face, where its section is a triangle of (3√3/2)(¾u)². The far faces move
/// the centre by a share u/L.
#[test]
fn corner_in_face() {
    let cube = Solid::cube();
    let down = DQuat::from_rotation_arc(DVec3::ONE.normalize(), DVec3::NEG_Z);
    let reach = 0.75f64.sqrt();
    for u in [1e-5, 1e-4, 1e-3] {
        let a = Solid::cuboid(DVec3::new(4.0, 4.0, 2.0)).at(-DVec3::Z, DQuat::IDENTITY);
        let b = cube.at(DVec3::Z * (reach - u), down);
        let found = contact(&a, &b);
        let area = 1.5 * 3f64.sqrt() * (0.75 * u).powi(2);
        assert_near(found.area / area, 1.0, 10.0 * u);
        assert_near(found.overlap / u, 1.0, 10.0 * u);
        assert_near(found.point.z / u, -0.25, 10.0 * u);
        assert!(found.pressure_centre.truncate().length() < u * 10.0 * u);
        assert!(found.normal.cross(DVec3::Z).length() < 10.0 * u);
    }
}

/// A box that rests with an edge on the ground, tilted by 30°: the overlap is a triangular prism, whose
/// analytic centre is its centroid; the width of the section is two thirds of the base.
#[test]
fn edge_on_face() {
    let (tilt, u) = (30f64.to_radians(), 1e-5);
    let ground = Solid::cuboid(DVec3::new(4.0, 4.0, 2.0)).at(-DVec3::Z, DQuat::IDENTITY);
    let turn = DQuat::from_rotation_y(tilt);
    let lowest = 0.5 * (tilt.sin() + tilt.cos());
    let block = Solid::cube().at(DVec3::Z * (lowest - u), turn);
    let found = contact(&ground, &block);
    let base = u / tilt.tan() + u * tilt.tan();
    assert_near(found.area / (2.0 / 3.0 * base), 1.0, 1e-3);
    assert_near(found.point.z / u, -1.0 / 3.0, 1e-3);
    // The vertical through the centroid leaves through the flatter face.
    assert_near(found.overlap / (2.0 / 3.0 * u), 1.0, 0.01 + 0.5);
    assert_near(found.pressure_centre.y, 0.0, 1e-9);
    assert_near(found.width, 1.0, 1e-4);
}

/// Blocks 1:100, ground with many faces: only a few rows are kept, and the contact does not change.
#[test]
fn box_on_large_ground() {
    let mut random = Random(8);
    let dome: Vec<DVec3> = (0..300).map(|_| 50.0 * random.direction()).collect();
    let flat: Vec<DVec3> = dome.iter().map(|v| v.with_z(v.z.min(0.0) + 15.0)).collect();
    let ground = Solid::hull(&flat);
    assert!(ground.faces.len() > 100);
    let a = ground.at(-15.0 * DVec3::Z, DQuat::IDENTITY);
    let b = Solid::cube().at(
        DVec3::new(3.0, -2.0, 0.5 - 1e-4),
        DQuat::from_rotation_z(0.3),
    );
    let found = contact(&a, &b);
    assert_near(found.area, 1.0, 1e-9);
    assert_near(found.overlap, 1e-4, 1e-12);
    let middle = DVec3::new(3.0, -2.0, -0.5e-4);
    assert!((found.pressure_centre - middle).length() < 1e-9);
    assert!((found.normal - DVec3::Z).length() < 1e-9);
}

/// A pyramid as flat as 4° pressed tip first into a face: four faces share the contact, and none of
/// them may dominate; the force stays on the axis for any rotation of the block about it.
#[test]
fn blunt_tip_in_face() {
    let rise = 0.5 * 4f64.to_radians().tan();
    let corner = |k: u32| {
        let sign = |bit: u32| if k >> bit & 1 == 1 { 0.5 } else { -0.5 };
        DVec3::new(sign(0), sign(1), 0.5 * sign(2))
    };
    let mut points: Vec<DVec3> = (0..8).map(corner).collect();
    points.push(-DVec3::Z * (0.25 + rise));
    let block = Solid::hull(&points);
    let ground = Solid::cuboid(DVec3::new(4.0, 4.0, 2.0)).at(-DVec3::Z, DQuat::IDENTITY);
    for k in 0..20 {
        let (u, turn) = (1e-4, DQuat::from_rotation_z(0.1 * k as f64));
        let found = contact(&ground, &block.at(DVec3::Z * (0.25 + rise - u), turn));
        // On the axis, y from the tip: log(u − y) + 4 log y is largest at y = 4u/5.
        let edge = 0.8 * u / rise;
        assert_near(found.area / (edge * edge), 1.0, 0.02);
        assert_near(found.overlap / u, 1.0, 0.02);
        assert!(found.pressure_centre.truncate().length() < 0.01 * edge);
        assert!(found.normal.cross(DVec3::Z).length() < 1e-4);
    }
}
