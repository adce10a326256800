//! The safety of a block among its neighbours, from its contacts or, if there are none, from its faces that lie on others.

use super::{Base, Plane, Sliding, TILT, Wrench, sliding, toppling, uplift};
use crate::{
    geometry::{Form, Part, Placed, Pose, Shape, area_of, clip, corners},
    rock::{Blocks, ContactPoint, Motion, Setup},
};
use glam::DVec3;

/// Cosine of the largest angle between contact normals of one plane, 5°: the contacts of a plane face differ by less.
const SAME: f64 = 0.996;

/// Factors of safety of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SafetyFactors {
    /// Safety against sliding.
    pub sliding: Sliding,
    /// Safety against uplift: see [`uplift`].
    pub uplift: f64,
    /// Safety against toppling over the edges of the plane with the largest normal force: see [`toppling`].
    pub toppling: f64,
}

/// The supports and loads of a block without the load of the fluid.
#[derive(Clone, Debug)]
pub struct Supports {
    supports: Vec<Support>,
    weight: DVec3,
    centre: DVec3,
    /// Point loads and applied acceleration.
    acting: Wrench,
}

/// The contacts in one plane.
#[derive(Clone, Debug, Default)]
struct Support {
    plane: Plane,
    /// Σ A tan φ and Σ A c.
    friction: f64,
    cohesion: f64,
    corners: Vec<DVec3>,
}

impl Support {
    /// Whether a block may begin to rotate about an axis through `edge`: no corner then moves into the plane by more than the
    /// tilt of contacts. The tilt is relative to the distance of the farthest corner from the axis, because rounding
    /// determines the direction of a corner on the axis.
    fn lets_turn(&self, axis: DVec3, edge: DVec3) -> bool {
        let directions = self.corners.iter().map(|x| axis.cross(*x - edge));
        let farthest = directions.clone().map(DVec3::length).fold(0.0, f64::max);
        let into = directions.map(|direction| -direction.dot(self.plane.normal));
        into.fold(0.0, f64::max) <= TILT * farthest
    }
}

impl SafetyFactors {
    /// The factors of the block `block` of `blocks`, which were created from `setup`, under the force (N) and the torque about
    /// its centroid (N m) of the `fluid`, buoyancy included; zero without a fluid. Point loads and the applied acceleration
    /// of the block are included; forces of its guides are not.
    pub fn of(setup: &Setup, blocks: &Blocks, block: usize, fluid: [DVec3; 2]) -> Self {
        Supports::of(setup, blocks, block).under(fluid)
    }
}

impl Supports {
    /// The supports of the block `block` of `blocks`, which were created from `setup`, at its present pose.
    pub fn of(setup: &Setup, blocks: &Blocks, block: usize) -> Self {
        let [force, torque] = blocks.applied_load(block);
        Self {
            supports: supports(setup, blocks, block),
            weight: blocks.mass(block) * blocks.gravity(),
            centre: blocks.pose(block).centre,
            acting: Wrench { force, torque },
        }
    }

    /// The factors of the block under the `force` (N) and `torque` about its centroid (N m) of a fluid, buoyancy included.
    pub fn under(&self, [force, torque]: [DVec3; 2]) -> SafetyFactors {
        let Self {
            supports,
            weight,
            centre,
            acting,
        } = self;
        let (weight, acting) = (*weight, *acting);
        let planes: Vec<Plane> = supports.iter().map(|support| support.plane).collect();
        let fluid = Wrench { force, torque };
        let force = fluid.force + acting.force;
        let resultant = weight + force;
        let pressed = |support: &&Support| -resultant.dot(support.plane.normal);
        let most = supports
            .iter()
            .max_by(|a, b| pressed(a).total_cmp(&pressed(b)));
        let base = most.map_or_else(Base::default, |support| Base {
            normal: support.plane.normal,
            corners: support.corners.clone(),
        });
        let others = supports.iter();
        let others = others.filter(|support| support.plane.normal != base.normal);
        let open = |axis: DVec3, edge: DVec3| {
            let mut others = others.clone();
            others.all(|support| support.lets_turn(axis, edge))
        };
        SafetyFactors {
            sliding: sliding(resultant, &planes),
            uplift: uplift(weight, force),
            toppling: toppling(weight, &[fluid, acting], *centre, &base, open),
        }
    }
}

/// The planes that support a block.
fn supports(setup: &Setup, blocks: &Blocks, block: usize) -> Vec<Support> {
    let mut supports: Vec<Support> = Vec::new();
    for touch in touching(setup, blocks, block) {
        let joint = blocks.joint([block, touch.other]);
        let same = |support: &Support| support.plane.normal.dot(touch.normal) > SAME;
        let known = supports.iter().position(same).unwrap_or_else(|| {
            supports.push(Support::default());
            supports.len() - 1
        });
        let support = &mut supports[known];
        let (area, mean) = (support.plane.area, support.plane.normal);
        let whole = area + touch.area;
        support.friction += touch.area * joint.friction_angle.tan();
        support.cohesion += touch.area * joint.cohesion;
        support.plane = Plane {
            normal: (area * mean + touch.area * touch.normal).normalize_or(touch.normal),
            area: whole,
            cohesion: support.cohesion / whole,
            friction_angle: (support.friction / whole).atan(),
        };
        support.corners.extend(touch.corners);
    }
    supports
}

/// Gap within which two faces touch, as a fraction of the block's radius: the rounding of scenes.
const CLOSED: f64 = 1e-4;
/// Smallest area of the touching patches of one direction, as a fraction of the square of the block's radius: the edges of the faces
/// next to the base reach the ground too, because contacts overlap.
const AREA: f64 = 1e-3;

/// A patch in which a block touches another one.
#[derive(Clone, Debug)]
struct Touching {
    /// The other block.
    pub other: usize,
    /// Unit normal into the block.
    pub normal: DVec3,
    /// Area, m².
    pub area: f64,
    /// Corners, m.
    pub corners: Vec<DVec3>,
}

/// The contacts of a block, and for blocks without contacts the patches of its plane faces that lie on other blocks: a block
/// that has just been placed has no contacts, and a block that forces do not move has none with others of that kind.
fn touching(setup: &Setup, blocks: &Blocks, block: usize) -> Vec<Touching> {
    let poses = blocks.poses();
    let own = blocks.contacts().filter(|c| c.blocks.contains(&block));
    let mut all: Vec<_> = own.map(|c| of_contact(setup, &poses, block, &c)).collect();
    if all.is_empty() || setup.blocks[block].motion != Motion::Free {
        let known: Vec<usize> = all.iter().map(|touch| touch.other).collect();
        all.extend(faces_on_others(setup, blocks, block, &known));
    }
    all
}

fn of_contact(setup: &Setup, poses: &[Pose], block: usize, contact: &ContactPoint) -> Touching {
    let [a, b] = [0, 1].map(|side| {
        let block = contact.blocks[side];
        let before = &setup.blocks[..block];
        let first: usize = before.iter().map(|block| block.shape.parts().len()).sum();
        let part: &Part = &setup.blocks[block].shape.parts()[contact.parts[side] - first];
        let mut placed = Placed::of(part, &poses[block]);
        placed.centre += if side == 1 {
            contact.image_shift
        } else {
            DVec3::ZERO
        };
        placed
    });
    // The normal points from the first block to the second, which may be a periodic image.
    let second = contact.blocks[1] == block;
    let back = if second {
        contact.image_shift
    } else {
        DVec3::ZERO
    };
    let mut corners = patch(contact.point, contact.normal, [&a, &b]);
    corners.iter_mut().for_each(|corner| *corner -= back);
    Touching {
        other: contact.blocks[usize::from(!second)],
        normal: if second {
            contact.normal
        } else {
            -contact.normal
        },
        area: contact.section,
        corners,
    }
}

/// The patches of the plane faces of a block that lie on other blocks or their periodic images, except on the `known` blocks.
fn faces_on_others(setup: &Setup, blocks: &Blocks, block: usize, known: &[usize]) -> Vec<Touching> {
    let shape = &setup.blocks[block].shape;
    let poses = blocks.poses();
    let (pose, radius) = (&poses[block], shape.radius());
    let mut found = Vec::new();
    for (other, (made, its)) in setup.blocks.iter().zip(&poses).enumerate() {
        let near = (1.0 + CLOSED) * radius + made.shape.radius();
        if other == block || known.contains(&other) {
            continue;
        }
        let apart = its.centre - pose.centre;
        let image_shifts = match blocks.periods() {
            Some(periods) => periods.image_shifts([block, other], apart, near),
            None => vec![DVec3::ZERO],
        };
        let within = image_shifts
            .iter()
            .filter(|shift| (apart + **shift).length() <= near);
        for shift in within {
            let image = Pose {
                centre: its.centre + *shift,
                ..*its
            };
            faces_on(
                (other, made.shape.parts()),
                &image,
                (shape, pose),
                &mut found,
            );
        }
    }
    // Terrain has many small pieces: they count together.
    let mut areas: Vec<(DVec3, f64)> = Vec::new();
    for touch in &found {
        let same = |(normal, _): &&mut (DVec3, f64)| normal.dot(touch.normal) > SAME;
        match areas.iter_mut().find(same) {
            Some((_, area)) => *area += touch.area,
            None => areas.push((touch.normal, touch.area)),
        }
    }
    areas.retain(|(_, area)| *area > AREA * radius * radius);
    found.retain(|touch| {
        areas
            .iter()
            .any(|(normal, _)| normal.dot(touch.normal) > SAME)
    });
    found
}

/// The patches of the plane faces of a shape that lie on the parts of another block at `image`.
fn faces_on(
    (other, parts): (usize, &[Part]),
    image: &Pose,
    (shape, pose): (&Shape, &Pose),
    found: &mut Vec<Touching>,
) {
    let radius = shape.radius();
    for its in parts.iter().map(|part| Placed::of(part, image)) {
        for part in shape.parts() {
            let Form::Convex(own) = &part.form else {
                continue;
            };
            for face in 0..own.faces().len() {
                let polygon = corners(own, face, part.offset, pose);
                let out = area_of(&polygon).1.normalize_or_zero();
                let shifted = polygon.iter().map(|x| x + CLOSED * radius * out);
                let corners = its.clipped(shifted.collect());
                let area = area_of(&corners).1.length();
                if area > 0.0 {
                    found.push(Touching {
                        other,
                        normal: -out,
                        area,
                        corners,
                    });
                }
            }
        }
    }
}

/// Cosine of the angle between a face and the contact plane above which the face bounds the patch: 10°. Faces at a smaller
/// angle are the touching faces, which overlap and tilt slightly.
const ACROSS: f64 = 0.985;

/// Corners of the patch around `point` (m) normal to the unit vector `normal`; spheres touch only in the point.
pub(super) fn patch(point: DVec3, normal: DVec3, parts: [&Placed; 2]) -> Vec<DVec3> {
    if parts.iter().any(|part| part.faces.is_empty()) {
        return vec![point];
    }
    let reach = 2.0 * parts[0].radius.min(parts[1].radius);
    let (u, v) = normal.any_orthonormal_pair();
    let square = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let mut corners: Vec<DVec3> = square.map(|(a, b)| point + reach * (a * u + b * v)).into();
    for part in parts {
        for face in &part.faces {
            let across = face.normal.dot(normal).abs() < ACROSS;
            if across {
                clip(&mut corners, |x| face.height(x - part.centre));
            }
        }
    }
    match corners.is_empty() {
        true => vec![point],
        false => corners,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A side wall parallel to the motion of a toppling block; its normal is tilted by `tilt` (rad) against the motion.
    fn side_wall(tilt: f64) -> Support {
        let corner = |(x, z)| DVec3::new(x, 0.0, z);
        Support {
            plane: Plane {
                normal: DVec3::new(tilt, 1.0, 0.0).normalize(),
                ..Plane::default()
            },
            corners: [(0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (0.0, 2.0)]
                .map(corner)
                .into(),
            ..Support::default()
        }
    }

    #[test]
    fn a_wall_along_the_way_holds_no_edge_whatever_the_tilt_of_its_contact() {
        for axis in [DVec3::Y, -DVec3::Y] {
            for tilt in [1e-6, -1e-6, 1e-4, -1e-4] {
                assert!(
                    side_wall(tilt).lets_turn(axis, DVec3::ZERO),
                    "{axis} {tilt}"
                );
            }
        }
        assert!(!side_wall(0.01).lets_turn(-DVec3::Y, DVec3::ZERO));
        // Rotation into the wall.
        assert!(!side_wall(0.0).lets_turn(DVec3::X, DVec3::ZERO));
        assert!(side_wall(0.0).lets_turn(-DVec3::X, DVec3::ZERO));
    }
}
