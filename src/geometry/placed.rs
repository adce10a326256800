//! A convex part in world coordinates: computed once per step, read by all of its pairs.

use super::{Form, HalfSpace, Part, Polyhedron, Pose};
use glam::{DMat3, DVec3};

/// A convex polyhedron, or a sphere if it has no faces, in world coordinates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Placed {
    /// Centroid, m.
    pub centre: DVec3,
    /// Deformation gradient F of its block: maps vectors of the block's frame to the world's.
    pub deformation: DMat3,
    /// Faces, distances from `centre`.
    pub faces: Vec<HalfSpace>,
    /// Vertices from `centre`, m.
    pub vertices: Vec<DVec3>,
    /// Radius of the bounding sphere about `centre`, m.
    pub radius: f64,
    /// Smallest distance of a face from `centre`, m.
    pub smallest_distance: f64,
}

impl Placed {
    /// A part of a block at a pose.
    pub fn of(part: &Part, pose: &Pose) -> Self {
        let mut placed = Self::default();
        match &part.form {
            Form::Convex(shape) => placed.update(shape, part.offset, pose),
            Form::Sphere { radius } => placed.update_sphere(*radius, part.offset, pose),
        }
        placed
    }

    /// Whether it is a sphere.
    pub fn is_sphere(&self) -> bool {
        self.faces.is_empty()
    }

    /// Becomes `other` moved by `shift` (m), reusing the allocated memory.
    pub fn copy_moved(&mut self, other: &Self, shift: DVec3) {
        self.centre = other.centre + shift;
        self.deformation = other.deformation;
        self.faces.clone_from(&other.faces);
        self.vertices.clone_from(&other.vertices);
        (self.radius, self.smallest_distance) = (other.radius, other.smallest_distance);
    }

    /// The part of a plane polygon with these corners (m) that lies inside; empty for a sphere.
    pub fn clipped(&self, mut corners: Vec<DVec3>) -> Vec<DVec3> {
        if self.faces.is_empty() {
            return Vec::new();
        }
        for face in &self.faces {
            clip(&mut corners, |x| face.height(x - self.centre));
        }
        corners
    }

    /// Places at `pose` the polyhedron whose centroid is `offset` (m) from that of its block, in the block's frame.
    /// Planes transform with F⁻ᵀ, so that a deformed block stays a convex polyhedron.
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

    /// Places at `pose` the sphere of `radius` (m) whose centre is `offset` (m) from the centroid of its block, in
    /// the block's frame. A sphere has no faces and does not deform.
    pub fn update_sphere(&mut self, radius: f64, offset: DVec3, pose: &Pose) {
        self.centre = pose.point(offset);
        self.deformation = pose.deformation;
        self.faces.clear();
        self.vertices.clear();
        self.radius = radius;
        self.smallest_distance = radius;
    }
}

/// Lower and upper corner of the bounding box of points; ∞ and −∞ without points.
pub(crate) fn bounding_box(points: impl IntoIterator<Item = DVec3>) -> [DVec3; 2] {
    let widen = |[low, high]: [DVec3; 2], x: DVec3| [low.min(x), high.max(x)];
    let empty = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    points.into_iter().fold(empty, widen)
}

/// Smallest and largest of some values; ∞ and −∞ without values.
pub(crate) fn min_max(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let widen = |[low, high]: [f64; 2], x: f64| [low.min(x), high.max(x)];
    let empty = [f64::INFINITY, f64::NEG_INFINITY];
    values.into_iter().fold(empty, widen)
}

/// Keeps the part of a plane polygon where `height` is at most zero (Sutherland & Hodgman 1974).
pub(crate) fn clip(corners: &mut Vec<DVec3>, height: impl Fn(DVec3) -> f64) {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (k, &b) in corners.iter().enumerate() {
        let a = corners[(k + corners.len() - 1) % corners.len()];
        let [at_a, at_b] = [height(a), height(b)];
        if (at_a > 0.0) != (at_b > 0.0) {
            kept.push(a + (b - a) * (at_a / (at_a - at_b)));
        }
        if at_b <= 0.0 {
            kept.push(b);
        }
    }
    *corners = kept;
}
