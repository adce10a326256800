//! What a block touches: its contacts, or where it has none yet the faces that lie on it.

use super::patch::patch;
use crate::{
    block::{Form, Part},
    bodies::{Blocks, ContactPoint, Pose, Setup},
    contact::Placed,
    immersed::{area_of, corners},
};
use glam::DVec3;

/// Gap within which two faces touch, as a share of the block's radius: the rounding of scenes.
const CLOSED: f64 = 1e-4;
/// Least area of a touch, as a share of the square of the block's radius: faces beside that on which a block stands reach
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

/// The contacts of a block. One that has just been put somewhere, or is held, has none: then the patches of its plane
/// faces that lie on others.
pub(super) fn touching(setup: &Setup, blocks: &Blocks, block: usize) -> Vec<Touching> {
    let poses = blocks.poses();
    let own = blocks.contacts().filter(|c| c.blocks.contains(&block));
    let contacts: Vec<_> = own.map(|c| of_contact(setup, &poses, block, &c)).collect();
    if contacts.is_empty() {
        return faces_on_others(setup, &poses, block);
    }
    contacts
}

fn of_contact(setup: &Setup, poses: &[Pose], block: usize, contact: &ContactPoint) -> Touching {
    let [a, b] = [0, 1].map(|side| {
        let block = contact.blocks[side];
        let before = &setup.blocks[..block];
        let first: usize = before.iter().map(|block| block.shape.parts().len()).sum();
        let part: &Part = &setup.blocks[block].shape.parts()[contact.parts[side] - first];
        let mut placed = Placed::of(part, &poses[block]);
        placed.centre += if side == 1 { contact.way } else { DVec3::ZERO };
        placed
    });
    // The normal goes from the first block to the second, which may be an image.
    let second = contact.blocks[1] == block;
    let back = if second { contact.way } else { DVec3::ZERO };
    let mut corners = patch(contact.point, contact.normal, [&a, &b]);
    corners.iter_mut().for_each(|corner| *corner -= back);
    Touching {
        other: contact.blocks[usize::from(!second)],
        normal: if second {
            contact.normal
        } else {
            -contact.normal
        },
        area: contact.area,
        corners,
    }
}

fn faces_on_others(setup: &Setup, poses: &[Pose], block: usize) -> Vec<Touching> {
    let shape = &setup.blocks[block].shape;
    let (pose, radius) = (&poses[block], shape.radius());
    let mut found = Vec::new();
    for (other, (made, its)) in setup.blocks.iter().zip(poses).enumerate() {
        let near = (1.0 + CLOSED) * radius + made.shape.radius();
        if other == block || pose.centre.distance(its.centre) > near {
            continue;
        }
        for its in made.shape.parts().iter().map(|part| Placed::of(part, its)) {
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
    found
}
