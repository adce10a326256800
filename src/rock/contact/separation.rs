//! Proof that there is no contact: a plane with each block on its own side, but for rounding.

use super::{Placed, Verdict, pair::Pair};
use glam::DVec3;

impl Placed {
    /// Largest n · v over the block, v from its centroid, m. `length` is |n|.
    pub(super) fn support(&self, n: DVec3, length: f64) -> f64 {
        if self.faces.is_empty() {
            return self.radius * length;
        }
        let heights = self.vertices.iter().map(|v| n.dot(*v));
        heights.fold(f64::NEG_INFINITY, f64::max)
    }
}

impl Pair<'_> {
    /// What the plane with the normal `n`, from the smaller to the larger block, proves: that the
    /// blocks are apart by more than `margin` (in L), or that they overlap by less. `n` may have any
    /// length; none proves nothing.
    pub fn judge(&self, n: DVec3, margin: f64) -> Option<Verdict> {
        let length = n.length();
        if length == 0.0 {
            return None;
        }
        let gap =
            n.dot(self.shift) - self.small.support(n, length) - self.large.support(-n, length);
        proven(gap, margin * self.length * length)
    }
}

/// What a plane with the gap `gap` proves, if rounding is `margin`.
pub(super) fn proven(gap: f64, margin: f64) -> Option<Verdict> {
    if gap > margin {
        Some(Verdict::Apart)
    } else if gap >= -margin {
        Some(Verdict::Undecided)
    } else {
        None
    }
}
