//! Spheres at seams: where pieces of one surface meet, a sphere touches the nearest piece only.
//!
//! A piece is hidden if its nearest point lies in another piece that is nearer, or in one as near that belongs to the same body.
//! Between pieces of different bodies, which sink under the sphere and move apart, distances much smaller than its overlap do not
//! count: of two such pieces that are as near, the one that has the contact keeps it.
//! When the sphere rolls over a seam, the nearest piece takes over the contact with its history.

use super::{candidate_pairs::CandidatePair, contact_list::Contact, narrowphase::Narrowphase};
use crate::rock::{
    contact::{Placed, nearest_point},
    law::{Force, History},
};
use glam::DVec3;
use std::collections::HashMap;

/// Distance within which pieces meet, relative to the size of the pieces.
const ROUNDING: f64 = 1e-9;
/// Step and gap between two bodies over which a sphere rolls as if there were none, relative to its overlap.
const STEP: f64 = 0.05;

/// What the seams change in the contacts of the pairs, by the index of the pair.
#[derive(Debug, Default)]
pub(super) struct Seams(HashMap<usize, Role>);

/// Part of a pair at a seam.
#[derive(Debug)]
pub(super) enum Role {
    /// Another piece is nearer: the pair has no contact. Whether that piece takes over the contact of the last step.
    Hidden { passed_on: bool },
    /// The pair takes over this contact of another pair.
    Successor(Box<Contact>),
}

/// A piece that a sphere touches. Vectors are in world axes.
struct Touch<'a> {
    /// Part number of the sphere.
    sphere: u32,
    /// Index of the pair.
    pair: usize,
    /// Whether the sphere is the first part of the pair.
    sphere_first: bool,
    /// Block of the piece; `None` if it is fixed.
    body: Option<u32>,
    piece: &'a Placed,
    /// From the centroid of the piece to the centre of the sphere, m.
    to_sphere: DVec3,
    /// From the centre of the sphere to the nearest point of the piece, m.
    to_point: DVec3,
    /// How far the sphere reaches beyond that point, m.
    overlap: f64,
    /// Whether the pair had a contact in the last step.
    touched: bool,
}

impl Touch<'_> {
    /// Whether this piece hides the other.
    fn hides(&self, other: &Self) -> bool {
        // Where each has the nearest point of the other, they are as near.
        self.has_point_of(other) && (!other.has_point_of(self) || self.precedes(other))
    }

    /// Whether this piece keeps the contact if the other is as near.
    fn precedes(&self, other: &Self) -> bool {
        if self.body == other.body {
            return self.pair < other.pair;
        }
        self.touched && !other.touched
    }

    /// Whether the nearest point of the other piece lies in this one.
    fn has_point_of(&self, other: &Self) -> bool {
        let step = if self.body == other.body {
            0.0
        } else {
            STEP * self.overlap
        };
        let tolerance = ROUNDING * (self.piece.radius + other.piece.radius) + step;
        let point = self.to_sphere + other.to_point;
        let mut faces = self.piece.faces.iter();
        faces.all(|face| face.normal.dot(point) <= face.distance + tolerance)
    }
}

impl Seams {
    /// The seams at which spheres stand.
    pub fn of(narrowphase: &Narrowphase<'_>, pairs: &[CandidatePair]) -> Self {
        let mut seams = Self::default();
        if !narrowphase.parts.has_spheres {
            return seams;
        }
        let touches = pairs.iter().enumerate();
        let touches = touches.filter_map(|(n, pair)| narrowphase.touch(n, pair));
        let mut touches: Vec<Touch<'_>> = touches.collect();
        touches.sort_by_key(|touch| touch.sphere);
        for own in touches.chunk_by(|a, b| a.sphere == b.sphere) {
            seams.add(narrowphase, pairs, own);
        }
        seams
    }

    /// Adds the pieces that one sphere touches.
    fn add(
        &mut self,
        narrowphase: &Narrowphase<'_>,
        pairs: &[CandidatePair],
        touches: &[Touch<'_>],
    ) {
        let hidden = |touch: &&Touch<'_>| touches.iter().any(|other| other.hides(touch));
        for touch in touches.iter().filter(hidden) {
            let before = narrowphase.contacts.of(&pairs[touch.pair]);
            let successor = before.and_then(|before| {
                let free = |other: &&Touch<'_>| {
                    other.hides(touch)
                        && !hidden(other)
                        && narrowphase.contacts.of(&pairs[other.pair]).is_none()
                        && !self.0.contains_key(&other.pair)
                };
                let other = touches.iter().find(free)?;
                let swapped = other.sphere_first != touch.sphere_first;
                let contact = narrowphase.passed_on(before, swapped, &pairs[other.pair]);
                Some((other.pair, Box::new(contact)))
            });
            let passed_on = successor.is_some();
            self.0
                .extend(successor.map(|(pair, contact)| (pair, Role::Successor(contact))));
            self.0.insert(touch.pair, Role::Hidden { passed_on });
        }
    }

    /// Part of the pair with this index at a seam; `None` if it is as any other pair.
    pub fn role(&self, pair: usize) -> Option<&Role> {
        self.0.get(&pair)
    }
}

impl Narrowphase<'_> {
    /// The piece that a pair touches, if it is a sphere and a polyhedron that overlap.
    fn touch(&self, n: usize, pair: &CandidatePair) -> Option<Touch<'_>> {
        let placed = pair.parts.map(|part| &self.parts.placed[part as usize]);
        let sphere_first = match placed.map(Placed::is_sphere) {
            [true, false] => true,
            [false, true] => false,
            _ => return None,
        };
        let shift = self.image_shift(pair);
        let [(sphere, ball), (part, piece)] = match sphere_first {
            true => [(pair.parts[0], placed[0]), (pair.parts[1], placed[1])],
            false => [(pair.parts[1], placed[1]), (pair.parts[0], placed[0])],
        };
        let shift = if sphere_first { -shift } else { shift };
        let to_sphere = ball.centre + shift - piece.centre;
        let reach = ball.radius + piece.radius;
        // A position that is not finite is left to the resolver.
        let square = to_sphere.length_squared();
        if square.is_nan() || square >= reach * reach {
            return None;
        }
        let to_point = nearest_point(piece, to_sphere) - to_sphere;
        let block = self.parts.block[part as usize];
        let fixed = self.bodies[block as usize].is_fixed();
        let overlap = ball.radius - to_point.length();
        (overlap > 0.0).then_some(Touch {
            sphere,
            pair: n,
            sphere_first,
            body: (!fixed).then_some(block),
            piece,
            to_sphere,
            to_point,
            overlap,
            touched: self.contacts.of(pair).is_some(),
        })
    }

    /// The contact `before` of another pair, in the other order if `swapped`, as that of this `pair`.
    fn passed_on(&self, before: &Contact, swapped: bool, pair: &CandidatePair) -> Contact {
        let blocks = pair.parts.map(|part| self.parts.block[part as usize]);
        let rotation = |block: u32| self.mid_steps[block as usize].rotation;
        let turn = rotation(blocks[0]).conjugate() * rotation(before.blocks[0]);
        let sign = if swapped { -1.0 } else { 1.0 };
        let history = before.force.history;
        Contact {
            parts: pair.parts,
            blocks,
            image_shift: self.image_shift(pair),
            normal: sign * before.normal,
            force: Force {
                history: History {
                    shear: sign * (turn * history.shear),
                    normal: sign * (turn * history.normal),
                    ..history
                },
                ..Force::default()
            },
            ..before.clone()
        }
    }
}
