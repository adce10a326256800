//! Face contacts against the volume of overlap, integrated line by line.

use super::contact;
use glam::{DQuat, DVec3};
use kit::contact::{Random, Solid};
use riprap::rock::contact::{Cache, Options, Placed, Resolver, Verdict};

/// Length inside both blocks of the vertical line through (x, y).
fn chord(blocks: [&Placed; 2], x: f64, y: f64) -> f64 {
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    for block in blocks {
        for face in &block.faces {
            let from = DVec3::new(x, y, 0.0) - block.centre;
            let slack = face.distance - face.normal.dot(from);
            let rate = face.normal.z;
            if rate > 1e-12 {
                high = high.min(slack / rate);
            } else if rate < -1e-12 {
                low = low.max(slack / rate);
            } else if slack < 0.0 {
                return 0.0;
            }
        }
    }
    (high - low).max(0.0)
}

/// Volume (m³) and its centroid in the plane, by the midpoint rule.
fn brute_force(blocks: [&Placed; 2]) -> (f64, f64, f64) {
    let cells = 240;
    let step = 2.0 / cells as f64;
    let (mut volume, mut x_moment, mut y_moment) = (0.0, 0.0, 0.0);
    for i in 0..cells {
        for j in 0..cells {
            let x = -1.0 + (i as f64 + 0.5) * step;
            let y = -1.0 + (j as f64 + 0.5) * step;
            let part = chord(blocks, x, y) * step * step;
            volume += part;
            x_moment += part * x;
            y_moment += part * y;
        }
    }
    (volume, x_moment / volume, y_moment / volume)
}

/// Boxes that lie on each other with a tilt of some 1e-4, as rocking blocks do: area times overlap
/// is the volume, and the pressure acts at its centroid, so that the force is that of an elastic bed.
#[test]
fn tilted_face_contact_is_an_elastic_bed() {
    let mut random = Random(9);
    for round in 0..25 {
        let a = Solid::cube().at(-DVec3::Z * 0.5, DQuat::IDENTITY);
        let tilt = random.vector().with_z(0.0) * 4e-4;
        let turn = DQuat::from_scaled_axis(tilt) * DQuat::from_rotation_z(random.between(0.0, 1.5));
        let side = random.vector().with_z(0.0) * 0.4;
        let block = Solid::cuboid(DVec3::new(1.0, 0.7, 0.9));
        let b = block.at(side + DVec3::Z * (0.45 - 1e-4), turn);
        let contact = contact(&a, &b);
        let (volume, x, y) = brute_force([&a, &b]);
        // The midpoint rule has an error of part of a cell at the edges.
        let error = contact.area * contact.overlap / volume - 1.0;
        assert!(
            error.abs() < 0.01,
            "round {round}: volume {volume} m³, error {error}"
        );
        let off = contact.pressure_centre.truncate() - glam::DVec2::new(x, y);
        assert!(off.length() < 3e-3, "round {round}: {off}");
        // The normal is between those of the faces.
        assert!(contact.normal.cross(DVec3::Z).length() < tilt.length() + 1e-4);
    }
}

/// From flat to standing on an edge: force and lever arm, area × overlap and pressure centre, are
/// continuous, and up to 5° they are exact.
#[test]
fn rocking_is_continuous() {
    let mut resolver = Resolver::new(Options::default());
    let a = Solid::cuboid(DVec3::new(3.0, 3.0, 1.0)).at(-DVec3::Z * 0.5, DQuat::IDENTITY);
    let depth = 1e-4;
    let mut cache = Cache::default();
    let mut before: Option<(f64, f64)> = None;
    for k in 0..=1000 {
        let tilt = (15.0 * k as f64 / 1000.0).to_radians();
        let turn = DQuat::from_rotation_y(tilt);
        let lowest = 0.5 * (tilt.sin() + tilt.cos());
        let b = Solid::cube().at(DVec3::Z * (lowest - depth), turn);
        let Verdict::Contact(contact) = resolver.resolve(&a, &b, &mut cache).unwrap() else {
            panic!("no contact at {tilt}");
        };
        let exact = if tilt.tan() <= depth / tilt.cos() {
            0.5 * (2.0 * depth - tilt.sin())
        } else {
            0.5 * depth * depth * (tilt.tan() + 1.0 / tilt.tan())
        };
        let share = contact.area * contact.overlap / exact;
        let corner = turn * DVec3::new(0.5, 0.0, -0.5);
        let arm = contact.pressure_centre.x - corner.x;
        if tilt < 5f64.to_radians() {
            assert!((share - 1.0).abs() < 0.02, "{k}: {share} of the volume");
        }
        if let Some((last, last_arm)) = before {
            assert!((share - last).abs() < 0.02, "{k}: {last} to {share}");
            let base = contact.width.min(1.0);
            assert!(
                (arm - last_arm).abs() < 0.5 * base,
                "{k}: arm {last_arm} to {arm}"
            );
        }
        before = Some((share, arm));
    }
}
