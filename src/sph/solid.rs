//! Convex parts of bodies at their initial positions, with their faces classed as exposed or internal.

use super::{Setup, layer_polygon::LayerPolygon, particle_lattice::ParticleLattice};
use crate::{
    geometry::{Form, HalfSpace, Shape, bounding_box},
    rock::{Block, Motion},
};
use glam::{DQuat, DVec3};

/// A convex part of a body.
#[derive(Clone, Debug, PartialEq)]
pub enum Solid {
    /// A polyhedron.
    Faces(Faces),
    /// A sphere.
    Sphere {
        /// Centre, m.
        centre: DVec3,
        /// Radius, m.
        radius: f64,
    },
}

/// Faces of a convex polyhedron.
#[derive(Clone, Debug, PartialEq)]
pub struct Faces {
    /// Centre of the bounding sphere, m.
    pub centre: DVec3,
    /// Radius of the bounding sphere, m.
    pub radius: f64,
    /// Faces in contact with the water.
    pub exposed: Vec<HalfSpace>,
    /// Faces inside other parts of the same body, or of fixed bodies if this one is fixed too.
    pub internal: Vec<HalfSpace>,
}

/// The parts of each of the `blocks` in the world frame.
pub(super) fn solids(blocks: &[Block], lattice: &ParticleLattice) -> Vec<Vec<Solid>> {
    let of = |block: &Block| {
        let parts = ConvexPart::of_block(block);
        let fixed = block.motion == Motion::Fixed;
        solids_of_parts(&parts, lattice.tolerance(), |part| {
            Solid::of(part, lattice, fixed)
        })
    };
    blocks.iter().map(of).collect()
}

/// Marks the faces at which fixed blocks cover each other as internal: no water can emerge there.
pub(super) fn mark_covered_faces(
    blocks: &[Block],
    solids: &mut [Vec<Solid>],
    lattice: &ParticleLattice,
) {
    let parts: Vec<_> = blocks.iter().map(ConvexPart::of_block).collect();
    let slack = lattice.spacing;
    for (index, block) in blocks.iter().enumerate() {
        if block.motion != Motion::Fixed {
            continue;
        }
        let fixed = |other: &usize| *other != index && blocks[*other].motion == Motion::Fixed;
        let all = (0..blocks.len())
            .filter(fixed)
            .flat_map(|other| &parts[other]);
        let all: Vec<_> = all.collect();
        for (part, solid) in parts[index].iter().zip(&mut solids[index]) {
            let overlaps = |other: &&&ConvexPart<'_>| {
                (other.low - slack).cmplt(part.high).all()
                    && (other.high + slack).cmpgt(part.low).all()
            };
            let near: Vec<_> = all.iter().filter(overlaps).copied().collect();
            solid.mark_internal_faces(part, &near, lattice.tolerance());
        }
    }
}

/// All parts of a body, with the faces inside other parts marked as internal.
fn solids_of_parts(
    parts: &[ConvexPart<'_>],
    tolerance: f64,
    of_part: impl Fn(&ConvexPart<'_>) -> Solid,
) -> Vec<Solid> {
    let solid = |(index, part): (usize, &ConvexPart<'_>)| {
        let mut solid = of_part(part);
        let others = parts.iter().enumerate();
        let others = others.filter(|(other, _)| *other != index);
        let others: Vec<&ConvexPart<'_>> = others.map(|(_, other)| other).collect();
        solid.mark_internal_faces(part, &others, tolerance);
        solid
    };
    parts.iter().enumerate().map(solid).collect()
}

impl Solid {
    /// The parts of a body, in its frame.
    pub fn parts(shape: &Shape) -> Vec<Self> {
        let parts = ConvexPart::of_shape(shape, DVec3::ZERO, DQuat::IDENTITY);
        solids_of_parts(&parts, 1e-6 * shape.radius(), Self::all_exposed)
    }

    /// A part with all faces exposed.
    fn all_exposed(part: &ConvexPart<'_>) -> Self {
        match part.form {
            Form::Sphere { radius } => Self::Sphere {
                centre: part.centre,
                radius: *radius,
            },
            Form::Convex(polyhedron) => Self::Faces(Faces {
                centre: part.centre,
                radius: polyhedron.radius(),
                exposed: part.planes(),
                internal: Vec::new(),
            }),
        }
    }

    /// The part in the frame of a block.
    pub(super) fn in_body_frame(self, block: &Block) -> Self {
        let to_body = block.rotation.inverse();
        let rotated = |plane: HalfSpace| HalfSpace {
            normal: to_body * plane.normal,
            distance: -plane.height(block.centre),
        };
        let rotated_all = |planes: Vec<HalfSpace>| planes.into_iter().map(rotated).collect();
        match self {
            Self::Sphere { centre, radius } => Self::Sphere {
                centre: to_body * (centre - block.centre),
                radius,
            },
            Self::Faces(faces) => Self::Faces(Faces {
                centre: to_body * (faces.centre - block.centre),
                exposed: rotated_all(faces.exposed),
                internal: rotated_all(faces.internal),
                ..faces
            }),
        }
    }

    /// The part without its faces at the ends of a period that it spans and, if it is `fixed`, without its faces at or
    /// beyond the faces of the domain.
    pub(super) fn of(part: &ConvexPart<'_>, lattice: &ParticleLattice, fixed: bool) -> Self {
        let tolerance = lattice.tolerance();
        let ends = [0, 1, 2].map(|axis| {
            let low = part.low[axis] <= lattice.low[axis] + tolerance;
            let high = part.high[axis] >= lattice.high[axis] - tolerance;
            if lattice.is_unbounded(axis) {
                [low && high, low && high]
            } else {
                [fixed && low, fixed && high]
            }
        });
        let is_end = |plane: &HalfSpace| {
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
        let mut solid = Self::all_exposed(part);
        if let Self::Faces(faces) = &mut solid {
            faces.exposed.retain(|plane| !is_end(plane));
        }
        solid
    }

    /// Whether a layer of this part lies behind the `internal` face of another part at `point` (m), which is just behind
    /// the face.
    pub(super) fn continues_layer(&self, internal: &HalfSpace, point: DVec3, slack: f64) -> bool {
        let Self::Faces(faces) = self else {
            return false;
        };
        let is_below = |face: &HalfSpace| {
            let apart = face.height(point) + internal.height(point);
            face.normal.dot(internal.normal) < 1e-9 - 1.0 && apart.abs() < slack
        };
        self.depth(point) > -slack && faces.exposed.iter().any(is_below)
    }

    /// Marks the faces of a part inside `others` as internal.
    fn mark_internal_faces(
        &mut self,
        part: &ConvexPart<'_>,
        others: &[&ConvexPart<'_>],
        tolerance: f64,
    ) {
        let Self::Faces(faces) = self else {
            return;
        };
        let planes = part.planes();
        let half_width = 2.0 * (part.high - part.low).length();
        let is_internal = |plane: &HalfSpace| {
            let rest = planes.iter().filter(|other| *other != plane).copied();
            let polygon = LayerPolygon::new(*plane, rest, part.centre, half_width);
            polygon.is_some_and(|polygon| {
                let samples = polygon.samples().into_iter();
                let mut outside = samples.map(|x| x + plane.normal * (1e3 * tolerance));
                outside.all(|x| others.iter().any(|other| other.depth(x) > -tolerance))
            })
        };
        let all = std::mem::take(&mut faces.exposed);
        let (internal, exposed): (Vec<_>, Vec<_>) = all.into_iter().partition(is_internal);
        faces.internal.extend(internal);
        faces.exposed = exposed;
    }

    /// Depth of `point` (m) below the exposed faces, m; negative outside.
    pub(super) fn depth(&self, point: DVec3) -> f64 {
        match self {
            Self::Sphere { centre, radius } => radius - centre.distance(point),
            Self::Faces(faces) => {
                let least = |least: f64, plane: &HalfSpace| least.min(-plane.height(point));
                // Beyond an internal face the point is in another part.
                let inside = faces.internal.iter().fold(f64::INFINITY, least);
                if inside < 0.0 {
                    inside
                } else {
                    faces.exposed.iter().fold(f64::INFINITY, least)
                }
            }
        }
    }
}

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

/// Whether water can reach a position (m) of a surface with the unit normal `outward`: it is in the domain, and none of the
/// solids contains the point a quarter of a spacing in front of it.
pub(crate) fn is_reached(
    setup: &Setup,
    solids: &[ConvexPart<'_>],
    at: DVec3,
    outward: DVec3,
) -> bool {
    let tolerance = 1e-6 * setup.spacing;
    let [low, high] = [setup.origin, setup.origin + setup.size];
    let mut inside = at.cmpge(low - tolerance) & at.cmple(high + tolerance);
    inside.set(1, inside.test(1) || setup.plane);
    let front = at + 0.25 * setup.spacing * outward;
    inside.all() && !solids.iter().any(|part| part.depth(front) > 0.0)
}

impl<'a> ConvexPart<'a> {
    /// The parts of `shape` with its centroid at `centre` (m).
    pub fn of_shape(shape: &'a Shape, centre: DVec3, rotation: DQuat) -> Vec<Self> {
        let part = |part: &'a crate::geometry::Part| {
            let centre = centre + rotation * part.offset;
            let [low, high] = match &part.form {
                Form::Sphere { radius } => [centre - *radius, centre + *radius],
                Form::Convex(polyhedron) => {
                    let corners = polyhedron.vertices().iter();
                    bounding_box(corners.map(|v| centre + rotation * *v))
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
