//! Contact of a sphere with a sphere or a polyhedron, in closed form.

use super::{ContactGeometry, Placed, projection::nearest};
use glam::DVec3;
use std::f64::consts::PI;

/// Gap (m, negative: overlap) and contact of a sphere with another block, from the block to it.
pub(super) struct Proximity {
    pub gap: f64,
    pub contact: ContactGeometry,
}

/// Two spheres: the section is the circle in which they meet, the common face of the lens.
pub(super) fn spheres(a: &Placed, b: &Placed) -> Proximity {
    let between = b.centre - a.centre;
    let distance = between.length();
    let normal = (between / distance).normalize_or(DVec3::X);
    // From the first centre to the circle; beyond a centre the whole sphere is in the other.
    let (r, q) = (a.radius, b.radius);
    let plane = (distance * distance + (r - q) * (r + q)) / (2.0 * distance);
    let circle = if plane > 0.0 && plane < distance {
        (r - plane) * (r + plane)
    } else {
        r.min(q).powi(2)
    };
    let along = plane.clamp(0.0, distance);
    let point = a.centre + normal * if along.is_nan() { 0.0 } else { along };
    Proximity {
        gap: distance - (r + q),
        contact: round(point, normal, r + q - distance, circle),
    }
}

/// A polyhedron and a sphere: the section is the sphere's circle in the plane through the
/// polyhedron's nearest point, across the normal. On a face that is the circle that the face cuts
/// out of the sphere; the face's edges do not cut it, so that area and force are continuous while
/// the sphere rolls over them.
pub(super) fn polyhedron(block: &Placed, sphere: &Placed) -> Proximity {
    let centre = sphere.centre - block.centre;
    let height = |k: usize| block.faces[k].normal.dot(centre) - block.faces[k].distance;
    let top =
        (0..block.faces.len()).fold(0, |best, k| if height(k) > height(best) { k } else { best });
    // The top face's plane, moved to the centre, has all of the block below it.
    let depth = height(top);
    let tolerance = 4.0 * f64::EPSILON * (block.radius + centre.length());
    let face = block.faces[top].normal;
    let (normal, distance, foot) = if depth <= tolerance {
        (face, depth, centre - face * depth)
    } else {
        let foot = nearest(&block.faces, centre, tolerance);
        let away = centre - foot;
        (away.normalize_or(face), away.length(), foot)
    };
    let radius = sphere.radius;
    let h = distance.max(0.0);
    let circle = ((radius - h) * (radius + h)).clamp(0.0, block.radius.powi(2));
    Proximity {
        gap: distance - radius,
        contact: round(block.centre + foot, normal, radius - distance, circle),
    }
}

/// A contact over a circle of the squared radius `square` (m²).
fn round(point: DVec3, normal: DVec3, overlap: f64, square: f64) -> ContactGeometry {
    ContactGeometry {
        point,
        normal,
        overlap,
        area: PI * square,
        pressure_centre: point,
        width: 2.0 * square.sqrt(),
        limit: 0.0,
    }
}
