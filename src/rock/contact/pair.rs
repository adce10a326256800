//! A pair in the frame in which it is resolved: origin at the smaller block's centroid, lengths
//! divided by the smaller block's size L. Without that shift and scale the linear program loses up
//! to three more digits.

use super::Placed;
use crate::geometry::HalfSpace;
use glam::DVec3;
use std::cmp::Ordering;

/// a · x ≤ b.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// Unit normal.
    pub normal: DVec3,
    /// Distance from the smaller block's centroid, in L.
    pub offset: f64,
}

/// Size ratio from which distant faces are left out. Below it few faces would be left out, and the result for blocks
/// of equal size, whose order depends on rounding, must not depend on that order.
const LARGER: f64 = 3.0;

/// Two blocks, ordered by size.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair<'a> {
    pub small: &'a Placed,
    pub large: &'a Placed,
    /// Whether the smaller block is the second argument.
    pub flipped: bool,
    /// From the smaller block's centroid to the larger one's, m.
    pub shift: DVec3,
    /// L, the diameter of the smaller block's bounding sphere, m.
    pub length: f64,
}

impl<'a> Pair<'a> {
    pub fn new(first: &'a Placed, second: &'a Placed) -> Self {
        let flipped = order(first, second) == Ordering::Greater;
        let (small, large) = if flipped {
            (second, first)
        } else {
            (first, second)
        };
        Self {
            small,
            large,
            flipped,
            shift: large.centre - small.centre,
            length: 2.0 * small.radius,
        }
    }

    /// Fills `rows`, those of the smaller block first; returns the number of these.
    ///
    /// Of a much larger block, only the faces that come within twice the smaller block's bounding
    /// sphere are kept. A plane outside the sphere does not cut the smaller block, so that the overlap
    /// and the verdict are exactly the same. The analytic centre is that of the kept
    /// faces: with the factor of two, a face is added or dropped at least a radius from the overlap, where
    /// its 1/t is small compared with that of the faces that bound the overlap.
    pub fn fill(&self, rows: &mut Vec<Row>) -> usize {
        let scale = self.length.recip();
        rows.clear();
        rows.extend(self.small.faces.iter().map(|face| Row {
            normal: face.normal,
            offset: face.distance * scale,
        }));
        let far = |face: &HalfSpace| Row {
            normal: face.normal,
            offset: (face.distance + face.normal.dot(self.shift)) * scale,
        };
        if self.large.radius < LARGER * self.small.radius {
            rows.extend(self.large.faces.iter().map(far));
            return self.small.faces.len();
        }
        rows.extend(self.large.faces.iter().map(far).filter(|r| r.offset < 1.0));
        if rows.len() == self.small.faces.len() {
            // Deep inside: the normal of the nearest face points outwards.
            let nearest = |a: &Row, b: &Row| a.offset.total_cmp(&b.offset);
            rows.extend(self.large.faces.iter().map(far).min_by(nearest));
        }
        self.small.faces.len()
    }

    /// Bound of the rounding error of a slack or a gap, in L: some units in the last place of the longest
    /// vector that enters it, including the positions of the blocks.
    pub fn rounding(&self) -> f64 {
        let place = self.small.centre.abs().max(self.large.centre.abs());
        let longest = self.length + self.large.radius + place.max_element();
        8.0 * f64::EPSILON * longest / self.length
    }
}

/// Orders two blocks by size, then by position, independently of the order of the arguments. Only
/// two blocks with the same sizes at the same position keep the order of the arguments.
fn order(a: &Placed, b: &Placed) -> Ordering {
    let place = |p: &Placed| p.centre.to_array();
    let key = |p: &Placed| (p.radius, p.smallest_distance);
    key(a)
        .partial_cmp(&key(b))
        .unwrap_or(Ordering::Equal)
        .then(a.faces.len().cmp(&b.faces.len()))
        .then(place(a).partial_cmp(&place(b)).unwrap_or(Ordering::Equal))
}

/// The last separating plane and the last contact point of a pair, in the frame of one of its
/// blocks. Both are hints that are verified before use: an outdated cache, or one of another pair,
/// costs time and changes no verdict. Plain data, for checkpoints.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct Cache {
    /// Normal of the plane, pointing away from the block in whose frame it is; zero if there is none.
    pub plane: [f64; 3],
    /// Contact point relative to the centroid of that block, m; zero if there is none.
    pub point: [f64; 3],
    /// Whether the pair was in contact when last resolved, so that the point is tried first.
    pub contact: bool,
    /// Whether the frame is that of the second block. It is that of the smaller block, so that the
    /// numbers do not depend on the order of the pair.
    pub second: bool,
}

impl Cache {
    /// The plane's normal from the smaller to the larger block, in world axes.
    pub(super) fn normal(&self, pair: &Pair<'_>) -> DVec3 {
        let n = DVec3::from_array(self.plane);
        if self.second == pair.flipped {
            pair.small.deformation * n
        } else {
            -(pair.large.deformation * n)
        }
    }

    /// The point from the smaller block's centroid, m, if there is one.
    pub(super) fn place(&self, pair: &Pair<'_>) -> Option<DVec3> {
        let p = DVec3::from_array(self.point);
        if p == DVec3::ZERO {
            None
        } else if self.second == pair.flipped {
            Some(pair.small.deformation * p)
        } else {
            Some(pair.large.deformation * p + pair.shift)
        }
    }

    /// Stores a plane's normal, from the smaller to the larger block, and a point (m from the smaller
    /// block's centroid).
    pub(super) fn hold(&mut self, pair: &Pair<'_>, normal: DVec3, point: Option<DVec3>) {
        let inverse = pair.small.deformation.inverse();
        self.plane = (inverse * normal).to_array();
        self.point = (inverse * point.unwrap_or_default()).to_array();
        self.second = pair.flipped;
    }
}
