//! What a contact is like: its centre, normal and section.

use super::{
    ContactGeometry, Normal, Resolver,
    normal::{barrier, overlap, potential},
    pair::Pair,
    section::Overlap,
};
use glam::DVec3;

impl Resolver {
    /// The contact around `start`, a point inside both (in L); its normal goes from the smaller to
    /// the larger block.
    pub(super) fn describe(
        &mut self,
        pair: &Pair<'_>,
        split: usize,
        start: DVec3,
    ) -> ContactGeometry {
        let mut point = start;
        self.counts.newton_steps += self.centring.run(&self.rows, 0.0, &mut point);
        let (rows, slacks) = (&self.rows[..], &self.centring.slacks[..]);
        let mut normal = barrier(rows, slacks, split);
        if self.options.normal == Normal::Potential {
            let depth = overlap(rows, slacks, split, normal);
            let least = pair
                .small
                .smallest_distance
                .min(pair.large.smallest_distance);
            let rounding = (2.0 * depth).max(0.01 * least / pair.length);
            normal = potential(rows, slacks, split, rounding);
        }
        let level = self.options.normal == Normal::Barrier;
        let around = Overlap {
            rows,
            slacks,
            split,
            normal,
        };
        let section = around.section(&mut self.polygons, level);
        let length = pair.length;
        let place = |x: DVec3| pair.small.centre + x * length;
        ContactGeometry {
            point: place(point),
            normal: section.normal,
            overlap: section.overlap * length,
            area: section.area * length * length,
            pressure_centre: place(point + section.pressure_centre),
            width: section.width * length,
            limit: 0.0,
        }
    }
}
