//! Where two parts touch: the polygon that both have in the plane of their contact.

use crate::geometry::{Placed, clip};
use glam::DVec3;

/// Cosine of the angle from which a face is across a contact's plane and bounds the patch: 10°. Those nearer to it are
/// the faces that touch, which overlap and tilt a little.
const ACROSS: f64 = 0.985;

/// Corners of the patch about `point` (m) across the unit vector `normal`; spheres touch in the point alone.
pub(super) fn patch(point: DVec3, normal: DVec3, parts: [&Placed; 2]) -> Vec<DVec3> {
    if parts.iter().any(|part| part.faces.is_empty()) {
        return vec![point];
    }
    let reach = 2.0 * parts[0].radius.min(parts[1].radius);
    let (u, v) = normal.any_orthonormal_pair();
    let square = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let mut corners: Vec<DVec3> = square.map(|(a, b)| point + reach * (a * u + b * v)).into();
    for part in parts {
        for face in &part.faces {
            let across = face.normal.dot(normal).abs() < ACROSS;
            if across {
                clip(&mut corners, |x| face.height(x - part.centre));
            }
        }
    }
    match corners.is_empty() {
        true => vec![point],
        false => corners,
    }
}
