//! Convex parts of blocks and of bodies of water at their initial positions.

use super::particle_lattice::ParticleLattice;
use crate::{
    geometry::{Form, HalfSpace, Shape},
    rock::Block,
};
use glam::{DQuat, DVec3};

/// A convex part in the world frame.
#[derive(Clone, Debug)]
pub(crate) struct ConvexPart<'a> {
    pub form: &'a Form,
    /// Its centroid, m.
    pub centre: DVec3,
    rotation: DQuat,
    /// Corners of the bounding box, m.
    pub low: DVec3,
    pub high: DVec3,
}

impl<'a> ConvexPart<'a> {
    /// The parts of `shape` with its centroid at `centre` (m).
    pub fn of_shape(shape: &'a Shape, centre: DVec3, rotation: DQuat) -> Vec<Self> {
        let part = |part: &'a crate::geometry::Part| {
            let centre = centre + rotation * part.offset;
            let (low, high) = match &part.form {
                Form::Sphere { radius } => (centre - *radius, centre + *radius),
                Form::Convex(polyhedron) => {
                    let corners = polyhedron.vertices().iter();
                    let corners = corners.map(|v| centre + rotation * *v);
                    let empty = (DVec3::INFINITY, DVec3::NEG_INFINITY);
                    corners.fold(empty, |(low, high), v| (low.min(v), high.max(v)))
                }
            };
            Self {
                form: &part.form,
                centre,
                rotation,
                low,
                high,
            }
        };
        shape.parts().iter().map(part).collect()
    }

    /// The parts of a block.
    pub fn of_block(block: &'a Block) -> Vec<Self> {
        Self::of_shape(&block.shape, block.centre, block.rotation)
    }

    /// The parts of a block and their periodic images that overlap the domain.
    pub fn with_images(block: &'a Block, lattice: &ParticleLattice) -> Vec<Self> {
        let mut parts = Self::of_block(block);
        for axis in (0..3).filter(|axis| lattice.is_periodic(*axis)) {
            let period = DVec3::AXES[axis] * (lattice.high[axis] - lattice.low[axis]);
            let shifted = |shift: DVec3| {
                let images = parts.iter().map(move |part| Self {
                    centre: part.centre + shift,
                    low: part.low + shift,
                    high: part.high + shift,
                    ..part.clone()
                });
                images.filter(|part| {
                    part.high[axis] > lattice.low[axis] && part.low[axis] < lattice.high[axis]
                })
            };
            let images: Vec<_> = shifted(period).chain(shifted(-period)).collect();
            parts.extend(images);
        }
        parts
    }

    /// Its faces in the world frame; a sphere has none.
    pub fn planes(&self) -> Vec<HalfSpace> {
        let Form::Convex(polyhedron) = self.form else {
            return Vec::new();
        };
        let face = |face: &HalfSpace| {
            let normal = self.rotation * face.normal;
            HalfSpace {
                normal,
                distance: face.distance + normal.dot(self.centre),
            }
        };
        polyhedron.faces().iter().map(face).collect()
    }

    /// Depth of `point` (m) below its surface, m; negative outside.
    pub fn depth(&self, point: DVec3) -> f64 {
        let from = self.rotation.inverse() * (point - self.centre);
        match self.form {
            Form::Sphere { radius } => radius - from.length(),
            Form::Convex(polyhedron) => {
                let depths = polyhedron.faces().iter().map(|f| -f.height(from));
                depths.fold(f64::INFINITY, f64::min)
            }
        }
    }

    /// Whether `point` (m) is inside, or closer to the part than `distance` (m).
    pub fn is_near(&self, point: DVec3, distance: f64) -> bool {
        if point.cmplt(self.low - distance).any() || point.cmpgt(self.high + distance).any() {
            return false;
        }
        let from = self.rotation.inverse() * (point - self.centre);
        match self.form {
            Form::Sphere { radius } => from.length() < radius + distance,
            Form::Convex(polyhedron) => {
                // A separating face plane makes the distance computation unnecessary.
                let apart = polyhedron
                    .faces()
                    .iter()
                    .any(|f| f.height(from) >= distance);
                !apart && polyhedron.distance(from) < distance
            }
        }
    }
}
