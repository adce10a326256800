//! A convex part of a block where it is, in cells.

use super::{Frame, Part as Row, frame::whole, tiles::Outline};
use crate::geometry::{Part, Placed, Pose};
use glam::DVec3;

/// A part of a shape at a pose.
pub fn outline(frame: &Frame, part: &Part, pose: &Pose) -> Outline {
    let cell = frame.units.cell;
    let placed = Placed::of(part, pose);
    let centre = frame.place(placed.centre);
    if placed.faces.is_empty() {
        let radius = placed.radius / cell;
        return Outline {
            centre,
            low: DVec3::splat(-radius),
            high: DVec3::splat(radius),
            radius,
            ..Outline::default()
        };
    }
    let (mut low, mut high) = (DVec3::ZERO, DVec3::ZERO);
    for corner in placed.vertices.iter().map(|v| *v / cell) {
        low = low.min(corner);
        high = high.max(corner);
    }
    let faces = placed.faces.iter();
    Outline {
        centre,
        low,
        high,
        faces: faces
            .map(|face| (face.normal, face.distance / cell))
            .collect(),
        radius: 0.0,
    }
}

/// The row of a part on the device, and its faces.
pub fn rows(outline: &Outline, block: u32, first_face: u32) -> (Row, Vec<[f32; 4]>) {
    let base = outline.centre.floor();
    let faces = outline.faces.iter().map(|(normal, distance)| {
        let [x, y, z] = normal.as_vec3().to_array();
        [x, y, z, *distance as f32]
    });
    let part = Row {
        base: whole(base),
        first_face,
        fraction: (outline.centre - base).as_vec3().to_array(),
        faces: outline.faces.len() as u32,
        low: outline.low.as_vec3().to_array(),
        radius: outline.radius as f32,
        high: outline.high.as_vec3().to_array(),
        block,
    };
    (part, faces.collect())
}
