//! Proof of contact or of none for a pair whose cache has none.

use super::{
    Resolver, Verdict, closed_form_proofs::smallest_slack, normal::barrier, pair::Pair,
    program::Optimum,
};
use crate::Result;
use glam::DVec3;

/// How often a pair whose cached point is outside has its faces moved out, and from which violation
/// on (in L) it is not worth it: each time costs 1 µs and brings the point in by a share, against
/// 50 µs for the linear program.
const WIDENINGS: usize = 4;
const LARGEST_WIDENING: f64 = 0.01;

/// What was found of a pair.
pub(super) enum Proof {
    /// A plane, its normal from the smaller to the larger block, and what it proves.
    Plane(DVec3, Verdict),
    /// A point inside both, in L.
    Point(DVec3),
    Neither,
}

impl Resolver {
    /// Proof where the cache has none; `near`: the cached point, outside.
    pub(super) fn prove(
        &mut self,
        pair: &Pair<'_>,
        split: usize,
        margin: f64,
        near: Option<DVec3>,
    ) -> Result<Proof> {
        if let Some(normal) = pair.separating_face(margin)
            && let Some(verdict) = pair.judge(normal, margin)
        {
            self.counts.guesses += 1;
            return Ok(Proof::Plane(normal, verdict));
        }
        let point = pair.point_between(&self.rows, split);
        if smallest_slack(&self.rows, point) > margin {
            self.counts.guesses += 1;
            return Ok(Proof::Point(point));
        }
        if let Some(near) = near {
            let proof = self.widen(pair, split, margin, near);
            let Proof::Neither = proof else {
                self.counts.guesses += 1;
                return Ok(proof);
            };
        }
        let rows = &self.rows[..];
        let test = |optimum: &Optimum<'_>| {
            if smallest_slack(rows, optimum.point) > margin {
                return Proof::Point(optimum.point);
            }
            let normal = optimum.normal(rows, split);
            match pair.judge(normal, margin) {
                Some(verdict) => Proof::Plane(normal.normalize(), verdict),
                None => Proof::Neither,
            }
        };
        self.counts.programs += 1;
        let optimum = self.program.solve(rows)?;
        let proof = test(&optimum);
        let Proof::Neither = proof else {
            return Ok(proof);
        };
        self.counts.programs += 1;
        let point = optimum.point;
        Ok(test(&self.program.magnify(rows, point)?))
    }

    /// Proof from a point just outside (method of centres, Huard 1967): all faces are moved out until
    /// the point is inside; the analytic centre of what they enclose is then deeper, inside the blocks
    /// themselves, or its normal keeps them apart.
    fn widen(&mut self, pair: &Pair<'_>, split: usize, margin: f64, near: DVec3) -> Proof {
        let mut point = near;
        for _ in 0..WIDENINGS {
            let widening = 1.25 * (margin - smallest_slack(&self.rows, point));
            if !(margin..LARGEST_WIDENING).contains(&widening) {
                break;
            }
            let rows = &self.rows[..];
            self.counts.newton_steps += self.centring.run(rows, widening, &mut point);
            if smallest_slack(rows, point) > margin {
                return Proof::Point(point);
            }
            let normal = barrier(rows, &self.centring.slacks, split);
            if let Some(verdict) = pair.judge(normal, margin) {
                return Proof::Plane(normal, verdict);
            }
        }
        Proof::Neither
    }
}
