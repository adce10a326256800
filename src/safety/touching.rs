//! What a block touches: its contacts, and where none are known the faces that lie on others.

use super::patch::patch;
use crate::{
    geometry::{Form, Part, Placed, Pose, Shape},
    psm::{area_of, corners},
    rock::{Blocks, ContactPoint, Motion, Setup},
};
use glam::DVec3;

/// Gap within which two faces touch, as a share of the block's radius: the rounding of scenes.
const CLOSED: f64 = 1e-4;
/// Least area of a touch, as a share of the square of the block's radius: faces next to that on which a block stands reach
/// its ground with their edges, by the overlap of contacts.
const AREA: f64 = 1e-3;

/// A patch in which a block touches another one.
#[derive(Clone, Debug)]
pub(super) struct Touching {
    /// The other block.
    pub other: usize,
    /// Unit normal into the block.
    pub normal: DVec3,
    /// m².
    pub area: f64,
    /// Corners, m.
    pub corners: Vec<DVec3>,
}

/// The contacts of a block. One that has just been put somewhere has none, and one that forces do not move has none with
/// others of that kind: with those that it has no contact with, the patches of its plane faces that lie on them.
pub(super) fn touching(setup: &Setup, blocks: &Blocks, block: usize) -> Vec<Touching> {
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
    // The normal goes from the first block to the second, which may be an image.
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

/// The patches of the plane faces of a block that lie on others, or on the images of others where space repeats, without
/// those that are `known`.
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
        let image_shifts = blocks.image_shifts([block, other], apart, near);
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
                if area > AREA * radius * radius {
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
