//! A convex part of a block where it is, in cells.

use super::{Frame, Part, frame::whole, tiles::Outline};
use crate::{
    block::{self, Form},
    bodies::Pose,
};
use glam::DVec3;

/// A part of a shape at a pose. A deformed block keeps its faces plane: {n·X ≤ d} becomes n' = F⁻ᵀn/|F⁻ᵀn|
/// and d' = d/|F⁻ᵀn|.
pub fn outline(frame: &Frame, part: &block::Part, pose: &Pose) -> Outline {
    let cell = frame.units.cell;
    let centre = frame.place(pose.point(part.offset));
    match &part.form {
        Form::Sphere { radius } => {
            let radius = radius / cell;
            Outline {
                centre,
                low: DVec3::splat(-radius),
                high: DVec3::splat(radius),
                radius,
                ..Outline::default()
            }
        }
        Form::Convex(shape) => {
            let turned = pose.deformation.inverse().transpose();
            let face = |face: &block::HalfSpace| {
                let normal = turned * face.normal;
                let length = normal.length();
                (normal / length, face.distance / (length * cell))
            };
            let corners = shape.vertices().iter();
            let corners = corners.map(|v| pose.deformation * *v / cell);
            let (mut low, mut high) = (DVec3::ZERO, DVec3::ZERO);
            for corner in corners {
                low = low.min(corner);
                high = high.max(corner);
            }
            Outline {
                centre,
                low,
                high,
                faces: shape.faces().iter().map(face).collect(),
                radius: 0.0,
            }
        }
    }
}

/// The row of a part on the device, and its faces.
pub fn rows(outline: &Outline, block: u32, first_face: u32) -> (Part, Vec<[f32; 4]>) {
    let base = outline.centre.floor();
    let faces = outline.faces.iter().map(|(normal, distance)| {
        let [x, y, z] = normal.as_vec3().to_array();
        [x, y, z, *distance as f32]
    });
    let part = Part {
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
