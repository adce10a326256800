//! Random pairs with a wanted gap, by parry's distance.

use super::solids::{Random, Solid};
use glam::{DQuat, DVec3};
use parry3d_f64::{math::Pose, query};
use riprap::rock::contact::Placed;

/// A pair and where it is.
pub struct Couple {
    /// The blocks in their own frames.
    pub solids: [Solid; 2],
    /// Their centres.
    pub centres: [DVec3; 2],
    /// Their rotations into the world.
    pub rotations: [DQuat; 2],
    /// L, size of the smaller block.
    pub length: f64,
}

impl Couple {
    /// Two blocks of diameters 1 and 1 to `ratio`, moved together along a random line until parry's
    /// gap is `gap`, in units of the smaller one (negative: that overlap). Along a line, and not the
    /// shortest way, since that would end vertex on vertex and not on a face or edge across edge.
    pub fn random(random: &mut Random, ratio: f64, gap: f64) -> Self {
        loop {
            let mut solids = [Solid::any(random), Solid::any(random)];
            if ratio > 1.0 {
                let which = random.below(2) as usize;
                solids[which] = solids[which].scaled(random.magnitude(1.0, ratio));
            }
            let radii = [solids[0].radius(), solids[1].radius()];
            let way = random.direction();
            let aside = random.vector() * 0.4 * (radii[0] + radii[1]);
            let couple = Self {
                centres: [DVec3::ZERO, way * 3.0 * (radii[0] + radii[1]) + aside],
                rotations: [random.rotation(), random.rotation()],
                solids,
                length: 2.0 * radii[0].min(radii[1]),
            };
            if let Some(couple) = couple.closed(way, gap) {
                return couple;
            }
        }
    }

    /// The second block moved along −`way`, by Newton's method on the gap, which is convex in the
    /// distance gone and so is never passed; the last bit along the normal. None if it passes by.
    fn closed(mut self, way: DVec3, gap: f64) -> Option<Self> {
        for _ in 0..30 {
            let there = self.oracle()?;
            let rate = there.normal1.dot(way);
            if rate < 0.05 {
                return None;
            }
            // Near enough that no other feature comes first, far enough that parry sees a gap.
            if there.dist < 0.002 * self.length {
                self.centres[1] -= there.normal1 * (there.dist - gap * self.length);
                return Some(self);
            }
            self.centres[1] -= way * (there.dist - 0.001 * self.length) / rate;
        }
        None
    }

    /// parry's contact, of any distance; none where its EPA fails.
    pub fn oracle(&self) -> Option<query::Contact> {
        let pose = |k: usize| Pose::from_parts(self.centres[k], self.rotations[k]);
        let [a, b] = &self.solids;
        query::contact(&pose(0), &a.oracle, &pose(1), &b.oracle, 1e6).expect("convex shapes")
    }

    /// Both blocks in the world.
    pub fn placed(&self) -> [Placed; 2] {
        std::array::from_fn(|k| self.solids[k].at(self.centres[k], self.rotations[k]))
    }
}
