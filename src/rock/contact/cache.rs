//! What a pair remembers from step to step.

use glam::DVec3;

use super::pair::Pair;

/// The last separating plane and the last point of contact of a pair, in the frame of one of its
/// blocks. Both are hints: they are tested before they are believed, so a cache that is old, or
/// belongs to another pair, costs time and changes no verdict. Plain data, for checkpoints.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct Cache {
    /// Normal of the plane, away from the block that holds it; zero: none.
    pub plane: [f64; 3],
    /// Point of contact from the centroid, m; zero: none.
    pub point: [f64; 3],
    /// Whether the pair was in contact when last seen, and the point is worth a try.
    pub contact: bool,
    /// Whether the frame is that of the second block. It is that of the smaller one, so that a pair
    /// in the other order remembers the same numbers.
    pub second: bool,
}

impl Cache {
    /// The plane's normal from the smaller to the larger block, in the world.
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

    /// Keeps a plane's normal, from the smaller to the larger block, and a point (m from the smaller
    /// block's centroid).
    pub(super) fn hold(&mut self, pair: &Pair<'_>, normal: DVec3, point: Option<DVec3>) {
        let inverse = pair.small.deformation.inverse();
        self.plane = (inverse * normal).to_array();
        self.point = (inverse * point.unwrap_or_default()).to_array();
        self.second = pair.flipped;
    }
}
