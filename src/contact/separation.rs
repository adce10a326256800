//! Proof that there is no contact: a plane with each block on its own side.

use super::{Placed, pair::Pair};
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
    /// Whether a plane with the normal `n`, from the smaller to the larger block and of any length,
    /// keeps the blocks apart by more than `margin` (in L).
    pub fn separates(&self, n: DVec3, margin: f64) -> bool {
        let length = n.length();
        let gap =
            n.dot(self.shift) - self.small.support(n, length) - self.large.support(-n, length);
        gap > margin * self.length * length
    }
}
