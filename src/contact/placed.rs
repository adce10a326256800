//! A polyhedron where it is now: computed once a step, read by all of its pairs.

use crate::{
    block::{HalfSpace, Polyhedron},
    bodies::Pose,
};
use glam::{DMat3, DVec3};

/// A convex polyhedron, or a sphere if it has no faces, in the world; vectors along the world's axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Placed {
    /// Centroid, m.
    pub centre: DVec3,
    /// F of its block: turns vectors of the block's frame into the world's.
    pub deformation: DMat3,
    /// Faces, distances from `centre`.
    pub faces: Vec<HalfSpace>,
    /// Vertices from `centre`, m.
    pub vertices: Vec<DVec3>,
    /// Radius about `centre` that holds all of it, m.
    pub radius: f64,
    /// Smallest distance of a face from `centre`, m.
    pub smallest_distance: f64,
}

impl Placed {
    /// Moves to `pose` the polyhedron whose centroid is `offset` (m) from that of its block, in the
    /// block's frame. Planes go with F⁻ᵀ, so that a deformed block stays a convex polyhedron.
    pub fn update(&mut self, shape: &Polyhedron, offset: DVec3, pose: &Pose) {
        let f = pose.deformation;
        let cofactor = f.inverse().transpose();
        self.centre = pose.point(offset);
        self.deformation = f;
        self.faces.clear();
        self.faces.extend(shape.faces().iter().map(|face| {
            let normal = cofactor * face.normal;
            let length = normal.length();
            HalfSpace {
                normal: normal / length,
                distance: face.distance / length,
            }
        }));
        self.vertices.clear();
        self.vertices
            .extend(shape.vertices().iter().map(|v| f * *v));
        let square = self.vertices.iter().map(|v| v.length_squared());
        self.radius = square.fold(0.0, f64::max).sqrt();
        let distances = self.faces.iter().map(|face| face.distance);
        self.smallest_distance = distances.fold(f64::INFINITY, f64::min);
    }

    /// Moves to `pose` the sphere of `radius` (m) whose centre is `offset` (m) from the centroid of
    /// its block, in the block's frame. A sphere has no faces and does not deform.
    pub fn update_sphere(&mut self, radius: f64, offset: DVec3, pose: &Pose) {
        self.centre = pose.point(offset);
        self.deformation = pose.deformation;
        self.faces.clear();
        self.vertices.clear();
        self.radius = radius;
        self.smallest_distance = radius;
    }
}
