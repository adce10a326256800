//! Convex parts of blocks and of water where they are at the start.

use super::lattice::Lattice;
use crate::{
    block::{Form, HalfSpace, Shape},
    bodies::Block,
};
use glam::{DQuat, DVec3};

/// A convex part in the world.
#[derive(Clone, Debug)]
pub(super) struct Placed<'a> {
    pub form: &'a Form,
    /// Its centroid, m.
    pub centre: DVec3,
    rotation: DQuat,
    /// Corners of the box around it, m.
    pub low: DVec3,
    pub high: DVec3,
}

impl<'a> Placed<'a> {
    /// The parts of `shape`, its centroid at `centre` (m).
    pub fn parts(shape: &'a Shape, centre: DVec3, rotation: DQuat) -> Vec<Self> {
        let part = |part: &'a crate::block::Part| {
            let centre = centre + rotation * part.offset;
            let (low, high) = match &part.form {
                Form::Sphere { radius } => (centre - *radius, centre + *radius),
                Form::Convex(polyhedron) => {
                    let corners = polyhedron.vertices().iter();
                    let corners = corners.map(|v| centre + rotation * *v);
                    let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
                    corners.fold(nothing, |(low, high), v| (low.min(v), high.max(v)))
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
    pub fn of(block: &'a Block) -> Vec<Self> {
        Self::parts(&block.shape, block.centre, block.rotation)
    }

    /// The parts of a block and, where the domain is periodic, their images that reach into it.
    pub fn seen(block: &'a Block, lattice: &Lattice) -> Vec<Self> {
        let mut seen = Self::of(block);
        for axis in (0..3).filter(|axis| lattice.periodic[*axis]) {
            let period = DVec3::AXES[axis] * (lattice.high[axis] - lattice.low[axis]);
            let moved = |way: DVec3| {
                let parts = seen.iter().map(move |part| Self {
                    centre: part.centre + way,
                    low: part.low + way,
                    high: part.high + way,
                    ..part.clone()
                });
                parts.filter(|part| {
                    part.high[axis] > lattice.low[axis] && part.low[axis] < lattice.high[axis]
                })
            };
            let images: Vec<_> = moved(period).chain(moved(-period)).collect();
            seen.extend(images);
        }
        seen
    }

    /// Its faces in the world; a sphere has none.
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

    /// How deep `point` (m) lies in it, m; negative outside.
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

    /// Whether `point` (m) is in it, or nearer to it than `distance` (m).
    pub fn is_near(&self, point: DVec3, distance: f64) -> bool {
        if point.cmplt(self.low - distance).any() || point.cmpgt(self.high + distance).any() {
            return false;
        }
        let from = self.rotation.inverse() * (point - self.centre);
        match self.form {
            Form::Sphere { radius } => from.length() < radius + distance,
            Form::Convex(polyhedron) => {
                // A plane between them spares most of the distances.
                let apart = polyhedron
                    .faces()
                    .iter()
                    .any(|f| f.height(from) >= distance);
                !apart && polyhedron.distance(from) < distance
            }
        }
    }
}
