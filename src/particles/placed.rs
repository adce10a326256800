//! Convex parts of blocks and of water where they are at the start.

use super::{facet::Facet, lattice::Lattice};
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

/// What a part is once faces are gone behind which there is no water.
#[derive(Clone, Debug)]
pub(super) enum Solid {
    /// What faces bound, in the world.
    Faces(Faces),
    /// A sphere.
    Sphere {
        /// m.
        centre: DVec3,
        /// m.
        radius: f64,
    },
}

/// Faces of a convex part.
#[derive(Clone, Debug)]
pub(super) struct Faces {
    /// Those that water may meet.
    pub bare: Vec<HalfSpace>,
    /// Those that lie inside other parts of the same block.
    pub seams: Vec<HalfSpace>,
}

impl Solid {
    /// A part whose faces at both ends of a period are none; if it is `fixed`, neither are those at the faces
    /// of the domain, behind which the walls, or nothing, are.
    pub fn of(part: &Placed<'_>, lattice: &Lattice, fixed: bool) -> Self {
        if let Form::Sphere { radius } = part.form {
            return Self::Sphere {
                centre: part.centre,
                radius: *radius,
            };
        }
        let tolerance = lattice.tolerance();
        let planes = part.planes();
        let ends = [0, 1, 2].map(|axis| {
            let low = part.low[axis] <= lattice.low[axis] + tolerance;
            let high = part.high[axis] >= lattice.high[axis] - tolerance;
            match lattice.endless(axis) {
                true => [low && high, low && high],
                false => [fixed && low, fixed && high],
            }
        });
        let ends = |plane: &HalfSpace| {
            let axis = (0..3).find(|axis| plane.normal[*axis].abs() > 1.0 - 1e-9);
            axis.is_some_and(|axis| {
                let end = usize::from(plane.normal[axis] > 0.0);
                let at = plane.distance * plane.normal[axis].signum();
                let beyond = match end {
                    0 => at <= lattice.low[axis] + tolerance,
                    _ => at >= lattice.high[axis] - tolerance,
                };
                ends[axis][end] && beyond
            })
        };
        let bare = planes.into_iter().filter(|plane| !ends(plane)).collect();
        Self::Faces(Faces {
            bare,
            seams: Vec::new(),
        })
    }

    /// Whether a layer of this part is parallel to `seam` of another where `point` (m), just behind it, is.
    pub fn follows(&self, seam: &HalfSpace, point: DVec3, slack: f64) -> bool {
        let Self::Faces(faces) = self else {
            return false;
        };
        let is_below = |face: &HalfSpace| {
            let apart = face.height(point) + seam.height(point);
            face.normal.dot(seam.normal) < 1e-9 - 1.0 && apart.abs() < slack
        };
        self.depth(point) > -slack && faces.bare.iter().any(is_below)
    }

    /// Sorts out the faces of a part that lie inside `others`, the other parts of its block.
    pub fn sew(&mut self, part: &Placed<'_>, others: &[&Placed<'_>], lattice: &Lattice) {
        let Self::Faces(faces) = self else {
            return;
        };
        let planes = part.planes();
        let reach = 2.0 * (part.high - part.low).length();
        let is_seam = |plane: &HalfSpace| {
            let rest = planes.iter().filter(|other| *other != plane).copied();
            let facet = Facet::new(*plane, rest, part.centre, reach);
            facet.is_some_and(|facet| {
                let samples = facet.samples().into_iter();
                let mut outside = samples.map(|x| x + plane.normal * (1e3 * lattice.tolerance()));
                outside.all(|x| {
                    others
                        .iter()
                        .any(|other| other.depth(x) > -lattice.tolerance())
                })
            })
        };
        let all = std::mem::take(&mut faces.bare);
        (faces.seams, faces.bare) = all.into_iter().partition(is_seam);
    }

    /// How deep `point` (m) lies in it, m; negative outside.
    pub fn depth(&self, point: DVec3) -> f64 {
        match self {
            Self::Sphere { centre, radius } => radius - centre.distance(point),
            Self::Faces(faces) => {
                let least = |least: f64, plane: &HalfSpace| least.min(-plane.height(point));
                // What is beyond a seam is another part's.
                let inside = faces.seams.iter().fold(f64::INFINITY, least);
                if inside < 0.0 {
                    inside
                } else {
                    faces.bare.iter().fold(f64::INFINITY, least)
                }
            }
        }
    }
}
