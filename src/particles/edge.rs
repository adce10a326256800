//! Where a layer of shells ends at a seam, beyond which another part of the block is.

use super::{lattice::Lattice, solid::Solid};
use crate::block::HalfSpace;
use glam::DVec3;

/// How far the solid beyond a seam must rise over a distance along the face, to be re-entrant. Layers of faces that
/// are less steep meet on the seam.
const STEEP: f64 = 0.9;

/// The edge of a layer on a seam.
pub(super) struct Edge {
    /// Some points on it, m; none if the layer does not reach the seam.
    pub points: Vec<DVec3>,
    /// How deep the layer is, m.
    pub depth: f64,
}

impl Edge {
    /// How far before `seam` the layer in `plane` is to end beside `solids`, the other parts of the block, m.
    ///
    /// ```text
    ///        │ B │                │ B │
    ///        │ . │ ½ Δx above     │ . │
    ///   ─────┼───┼─────      ┌────┼ . ├─────
    ///     .  .  .  .  .      │    │ . .  .  .
    ///          A             │  C │   │  A
    /// ```
    ///
    /// Left, a layer of A follows below the seam: half a spacing before it. Right, no face of C is between the layers
    /// of A and B, which both go on behind the edge, as deep into C as the layers are together. Else on it.
    pub fn end(
        &self,
        plane: &HalfSpace,
        seam: &HalfSpace,
        solids: &[&Solid],
        lattice: &Lattice,
    ) -> f64 {
        let half = 0.5 * lattice.spacing;
        let slack = 1e3 * lattice.tolerance();
        let follows = |x: &DVec3| {
            let behind = *x + seam.normal * half;
            solids.iter().any(|s| s.follows(seam, behind, slack))
        };
        if self.points.iter().any(follows) {
            return half;
        }
        let along = plane.normal.dot(seam.normal);
        // In the plane of the layer away from the seam, and in that of the seam up to the face.
        let out = (seam.normal - plane.normal * along).normalize_or_zero();
        let up = (plane.normal - seam.normal * along) / (1.0 - along * along).max(1e-9);
        let rises = |x: &DVec3| {
            let x = *x + up * self.depth + (out + plane.normal * STEEP) * (10.0 * slack);
            solids.iter().any(|solid| solid.depth(x) > 0.0)
        };
        match !self.points.is_empty() && self.points.iter().all(rises) {
            true => half - f64::from(lattice.layers) * lattice.spacing,
            false => 0.0,
        }
    }
}
