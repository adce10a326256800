//! Pressure centre of edge and corner contacts: against integration line by line, and without jumps.

use super::{contact, verdict};
use glam::{DQuat, DVec3};
use kit::{
    assert_near, assert_relative,
    contact::{Couple, Random, Solid},
};
use riprap::{
    geometry::HalfSpace,
    rock::contact::{ContactGeometry, Placed, Verdict},
};

/// Distance from `x` along `n` to the surface of the block; `None` outside.
fn way(block: &Placed, x: DVec3, n: DVec3) -> Option<f64> {
    let mut way = f64::INFINITY;
    for face in &block.faces {
        let slack = face.distance - face.normal.dot(x - block.centre);
        if slack < 0.0 {
            return None;
        }
        let rate = face.normal.dot(n);
        if rate > 0.0 {
            way = way.min(slack / rate);
        }
    }
    Some(way)
}

/// Area of the section perpendicular to the normal, and the centroid of the distance through the overlap over
/// it, by the midpoint rule.
fn brute_force(a: &Placed, b: &Placed, contact: &ContactGeometry) -> (f64, DVec3) {
    const CELLS: i32 = 301;
    let step = 2.0 * contact.width / f64::from(CELLS);
    let (p, q) = contact.normal.any_orthonormal_pair();
    let (mut count, mut volume, mut moment) = (0.0, 0.0, DVec3::ZERO);
    for i in 0..CELLS * CELLS {
        let at = |k: i32| (f64::from(k) + 0.5) * step - contact.width;
        let x = contact.point + p * at(i % CELLS) + q * at(i / CELLS);
        let up = way(a, x, contact.normal);
        let down = way(b, x, -contact.normal);
        if let (Some(up), Some(down)) = (up, down) {
            count += 1.0;
            volume += up + down;
            moment += (up + down) * (x - contact.point);
        }
    }
    (count * step * step, contact.point + moment / volume)
}

#[test]
fn acts_in_the_centroid_of_the_overlap_over_the_section() {
    let mut random = Random(12);
    let mut found = 0;
    for _ in 0..300 {
        let overlap = random.magnitude(1e-3, 0.05);
        let couple = Couple::random(&mut random, 1.0, -overlap);
        let [a, b] = couple.placed();
        // Faces that lie on each other, up to 10°, use a different section.
        let flat = 10f64.to_radians().cos();
        let faces = |f: &HalfSpace| b.faces.iter().any(|g| -f.normal.dot(g.normal) > flat);
        if a.faces.iter().any(faces) {
            continue;
        }
        let Verdict::Contact(contact) = verdict(&a, &b) else {
            continue;
        };
        found += 1;
        let (area, centre) = brute_force(&a, &b, &contact);
        // Cells along the rim of a thin section are in or out: 2 (2/301) of its length over its thickness.
        let rim = 4.0 / 301.0 * contact.width.powi(2) / contact.area;
        assert_relative(area, contact.area, rim);
        let error = centre.distance(contact.pressure_centre) / contact.width;
        assert!(error < 0.2 * rim, "{error} of the width, {contact:?}");
    }
    assert!(found > 100, "{found}");
}

/// A tilted cube that stands on an edge, with upright sides: a side that leans in or out by the last bit
/// does not change the contact.
#[test]
fn does_not_jump_when_a_face_beside_it_passes_through_upright() {
    let cube = Solid::cube();
    let below = cube.at(-DVec3::Z * 0.5, DQuat::IDENTITY);
    for tilt in [5.5, 7.0, 12.0, 30.0f64] {
        let turn = DQuat::from_rotation_y(tilt.to_radians());
        let height = (turn * DVec3::new(0.5, 0.5, 0.5)).z;
        let place = |lean: f64| {
            let turn = DQuat::from_rotation_x(lean) * turn;
            let at = DVec3::new(0.2, 0.0, height - 0.004);
            contact(&below, &cube.at(at, turn))
        };
        let [left, right] = [-1e-13, 1e-13].map(place);
        let way = left.pressure_centre.distance(right.pressure_centre);
        assert!(way < 1e-9, "{way} m at {tilt}°");
        assert_near(left.area, right.area, 1e-9);
        assert!(left.normal.distance(right.normal) < 1e-9);
    }
}
