//! Gaps that layers of different fixed blocks leave where they meet.

use super::{crowd::Crowd, lattice::Lattice};
use glam::DVec3;

/// Distance (of the spacing) from all others at which a point fills a gap: above half a diagonal of a square, so
/// that a regular layer has none.
const WIDE: f64 = 0.72;

/// How far from where a point was refused its place is sought, of the spacing.
const REACH: f64 = 1.0;

/// How much deeper another block may be at a point than its own, of the spacing: beyond that layers of the other
/// are there already.
const BESIDE: f64 = 0.25;

/// A point of a layer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Laid {
    /// m.
    pub at: DVec3,
    /// Of the layer.
    pub normal: DVec3,
}

/// How deep a point lies in fixed blocks.
pub(super) struct Depths {
    /// Below the surface of the block whose layer it is in, m; below 0 outside.
    pub own: f64,
    /// Below that of the block in which it is deepest, m.
    pub deepest: f64,
    /// Whose that is.
    pub block: usize,
}

/// The place near `refused` in its layer that is farthest from all of `crowd`, and whose it is, if there is a gap.
///
/// Rows of two blocks that meet have phases of their own: where the last of one is nearer than the least distance to
/// the first of the other it is refused, and up to 1.6 spacings are left, through which water leaks.
pub(super) fn gap(
    refused: Laid,
    depths: impl Fn(DVec3) -> Option<Depths>,
    crowd: &Crowd<'_>,
    lattice: &Lattice,
) -> Option<(DVec3, usize)> {
    let spacing = lattice.spacing;
    let room = |x: DVec3| {
        let there = depths(x)?;
        let least = lattice.depth(0) - 1e3 * lattice.tolerance();
        let fits = there.own >= least && there.deepest <= there.own + BESIDE * spacing;
        fits.then(|| (crowd.nearest(x), there.block))
    };
    let u = refused.normal.any_orthonormal_vector();
    let v = refused.normal.cross(u);
    let (mut best, mut place) = (room(refused.at), refused.at);
    let mut step = 0.5 * spacing;
    while step > 0.05 * spacing {
        let from = place;
        for turn in 0..8 {
            let (sin, cos) = (f64::from(turn) * std::f64::consts::FRAC_PI_4).sin_cos();
            let x = from + (u * cos + v * sin) * step;
            if x.distance(refused.at) > REACH * spacing {
                continue;
            }
            let there = room(x);
            let farther = |(distance, _): (f64, usize)| {
                best.is_none_or(|(most, _)| distance > most + lattice.tolerance())
            };
            if there.is_some_and(farther) {
                (best, place) = (there, x);
            }
        }
        if place == from {
            step *= 0.5;
        }
    }
    best.filter(|(distance, _)| *distance >= WIDE * spacing)
        .map(|(_, block)| (place, block))
}
