//! What water meets of a body.

use super::{facet::Facet, lattice::Lattice, placed::Placed};
use crate::{
    block::{Form, HalfSpace, Shape},
    bodies::{Block, Motion},
};
use glam::{DQuat, DVec3};

/// A convex part of a body without the faces behind which there is no water.
#[derive(Clone, Debug, PartialEq)]
pub enum Solid {
    /// What faces bound.
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
#[derive(Clone, Debug, PartialEq)]
pub struct Faces {
    /// Centre of a sphere around the part, m.
    pub centre: DVec3,
    /// Radius of that, m.
    pub radius: f64,
    /// Those that water may meet.
    pub bare: Vec<HalfSpace>,
    /// Those that lie inside other parts of the same body, or of others beside which it never moves.
    pub seams: Vec<HalfSpace>,
}

/// What there is of each of the `blocks` in the world.
pub(super) fn solids(blocks: &[Block], lattice: &Lattice) -> Vec<Vec<Solid>> {
    let of = |block: &Block| {
        let parts = Placed::of(block);
        let fixed = block.motion == Motion::Fixed;
        sewn(&parts, lattice.tolerance(), |part| {
            Solid::of(part, lattice, fixed)
        })
    };
    blocks.iter().map(of).collect()
}

/// Makes seams of the faces at which blocks that never move cover each other: no water comes out there.
pub(super) fn join(blocks: &[Block], solids: &mut [Vec<Solid>], lattice: &Lattice) {
    let parts: Vec<_> = blocks.iter().map(Placed::of).collect();
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
            let meets = |other: &&&Placed<'_>| {
                (other.low - slack).cmplt(part.high).all()
                    && (other.high + slack).cmpgt(part.low).all()
            };
            let near: Vec<_> = all.iter().filter(meets).copied().collect();
            solid.sew(part, &near, lattice.tolerance());
        }
    }
}

/// All parts of a body, their seams sorted out.
fn sewn(parts: &[Placed<'_>], tolerance: f64, of: impl Fn(&Placed<'_>) -> Solid) -> Vec<Solid> {
    let solid = |(index, part): (usize, &Placed<'_>)| {
        let mut solid = of(part);
        let others = parts.iter().enumerate();
        let others = others.filter(|(other, _)| *other != index);
        let others: Vec<&Placed<'_>> = others.map(|(_, other)| other).collect();
        solid.sew(part, &others, tolerance);
        solid
    };
    parts.iter().enumerate().map(solid).collect()
}

impl Solid {
    /// The parts of a body, in its frame.
    pub fn parts(shape: &Shape) -> Vec<Self> {
        let parts = Placed::parts(shape, DVec3::ZERO, DQuat::IDENTITY);
        sewn(&parts, 1e-6 * shape.radius(), Self::whole)
    }

    /// A part with all its faces.
    fn whole(part: &Placed<'_>) -> Self {
        match part.form {
            Form::Sphere { radius } => Self::Sphere {
                centre: part.centre,
                radius: *radius,
            },
            Form::Convex(polyhedron) => Self::Faces(Faces {
                centre: part.centre,
                radius: polyhedron.radius(),
                bare: part.planes(),
                seams: Vec::new(),
            }),
        }
    }

    /// The same in the frame of a block.
    pub(super) fn seen_from(self, block: &Block) -> Self {
        let back = block.rotation.inverse();
        let turned = |plane: HalfSpace| HalfSpace {
            normal: back * plane.normal,
            distance: -plane.height(block.centre),
        };
        let turned_all = |planes: Vec<HalfSpace>| planes.into_iter().map(turned).collect();
        match self {
            Self::Sphere { centre, radius } => Self::Sphere {
                centre: back * (centre - block.centre),
                radius,
            },
            Self::Faces(faces) => Self::Faces(Faces {
                centre: back * (faces.centre - block.centre),
                bare: turned_all(faces.bare),
                seams: turned_all(faces.seams),
                ..faces
            }),
        }
    }

    /// A part whose faces at both ends of a period are none; if it is `fixed`, neither are those at the faces
    /// of the domain, behind which the walls, or nothing, are.
    pub(super) fn of(part: &Placed<'_>, lattice: &Lattice, fixed: bool) -> Self {
        let tolerance = lattice.tolerance();
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
        let mut solid = Self::whole(part);
        if let Self::Faces(faces) = &mut solid {
            faces.bare.retain(|plane| !ends(plane));
        }
        solid
    }

    /// Whether a layer of this part is parallel to `seam` of another where `point` (m), just behind it, is.
    pub(super) fn follows(&self, seam: &HalfSpace, point: DVec3, slack: f64) -> bool {
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
    fn sew(&mut self, part: &Placed<'_>, others: &[&Placed<'_>], tolerance: f64) {
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
                let mut outside = samples.map(|x| x + plane.normal * (1e3 * tolerance));
                outside.all(|x| others.iter().any(|other| other.depth(x) > -tolerance))
            })
        };
        let all = std::mem::take(&mut faces.bare);
        let (seams, bare): (Vec<_>, Vec<_>) = all.into_iter().partition(is_seam);
        faces.seams.extend(seams);
        faces.bare = bare;
    }

    /// How deep `point` (m) lies in it, m; negative outside.
    pub(super) fn depth(&self, point: DVec3) -> f64 {
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
