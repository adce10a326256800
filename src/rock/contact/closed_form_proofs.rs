//! Cheap proofs for a pair without history, tried before the linear program.

use super::pair::{Pair, Row};
use crate::geometry::HalfSpace;
use glam::DVec3;

impl Pair<'_> {
    /// A face of one block that has all of the other outside, but for `margin` (in L): its normal from
    /// the smaller to the larger block.
    pub fn separating_face(&self, margin: f64) -> Option<DVec3> {
        let margin = margin * self.length;
        let clear = |face: &HalfSpace, shift: DVec3, vertices: &[DVec3]| {
            let height = face.normal.dot(shift) - face.distance + margin;
            // A face that looks away from the other block's centroid cannot keep it off.
            height > 0.0 && vertices.iter().all(|v| face.normal.dot(*v) >= -height)
        };
        let (small, large) = (self.small, self.large);
        let own = small.faces.iter();
        let mut own = own.filter(|f| clear(f, self.shift, &large.vertices));
        let other = large.faces.iter();
        let mut other = other.filter(|f| clear(f, -self.shift, &small.vertices));
        let found = own.next().map(|f| f.normal);
        found.or_else(|| other.next().map(|f| -f.normal))
    }

    /// A point of the line of centres that is inside all `rows`, in L, if there is one.
    pub fn point_between(&self, rows: &[Row], split: usize) -> DVec3 {
        let line = self.shift / self.length;
        let (own, other) = rows.split_at(split);
        // The line leaves the smaller block at `out`, and enters the larger one at `enter`.
        let out = own.iter().fold(1.0, |s: f64, row| {
            let rate = row.normal.dot(line);
            if rate > 0.0 {
                s.min(row.offset / rate)
            } else {
                s
            }
        });
        let enter = other.iter().fold(0.0, |s: f64, row| {
            let rate = row.normal.dot(line);
            if rate < 0.0 {
                s.max(row.offset / rate)
            } else {
                s
            }
        });
        0.5 * (out + enter) * line
    }
}

/// Smallest slack b − a · x over all rows.
pub(super) fn smallest_slack(rows: &[Row], x: DVec3) -> f64 {
    let slacks = rows.iter().map(|row| row.offset - row.normal.dot(x));
    slacks.fold(f64::INFINITY, f64::min)
}
