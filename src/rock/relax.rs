//! Removes overlaps of blocks before the first step.

use super::{Blocks, contact_list::DISTANCES_PER_LIMIT, deforming::pose};
use crate::{
    Error, Result,
    error::Overlap,
    rock::{
        broadphase::Broadphase,
        contact::{Options, Placed, Resolver, Verdict},
    },
};
use glam::DVec3;

/// Overlap at which blocks just touch, as a fraction of the allowed one.
const TOUCHING: f64 = 1e-3;
/// Sweeps in which the largest overlap must halve; otherwise there is no room.
const PATIENCE: usize = 100;
/// Component of the normal along a guide from which the block moves along the guide.
const LEAST_ALONG_GUIDE: f64 = 0.01;

impl Blocks {
    /// Pushes overlapping blocks apart along their contact normals, pair after pair, until they only just touch. Overlaps up to
    /// [`Setup::start_overlap`](super::Setup::start_overlap) may remain between blocks that have no room. The blocks of a pair move in inverse proportion to their
    /// masses; blocks with the same centre, whose contact has no normal, along gravity. No block rotates, fixed and driven
    /// blocks do not move, guided ones along their guides only, and velocities do not change.
    ///
    /// Returns the number of sweeps over all pairs, at most `sweeps`.
    ///
    /// # Errors
    /// [`Error::Overlaps`] with the overlaps left after `sweeps`; the blocks keep their last positions. Also the errors of
    /// the broadphase.
    pub async fn relax(
        &mut self,
        broadphase: &mut impl Broadphase,
        sweeps: usize,
    ) -> Result<usize> {
        let mut resolver = Resolver::new(Options::default());
        let mut left = Vec::new();
        // Largest overlap over the allowed one, when last compared.
        let mut before = f64::INFINITY;
        for sweep in 0..=sweeps {
            if self.needs_pairs() {
                let pairs = broadphase.pairs(&self.aabbs()).await?;
                self.set_pairs(pairs)?;
            }
            let largest;
            (left, largest) = self.push_apart(&mut resolver)?;
            let slow = sweep % PATIENCE == PATIENCE - 1 && largest > 0.5 * before;
            if left.is_empty() && (largest <= TOUCHING || slow || sweep == sweeps) {
                return Ok(sweep);
            }
            if sweep % PATIENCE == PATIENCE - 1 {
                before = largest;
            }
        }
        left.sort_by(|a, b| b.depth.total_cmp(&a.depth));
        Err(Error::Overlaps { pairs: left })
    }

    /// Displacement of a block per impulse along `normal`, 1/kg: along its guide, and zero if it does not move.
    fn mobility(&self, block: usize, normal: DVec3) -> DVec3 {
        let body = &self.bodies[block];
        let deforming = self.deforming.of(body);
        if deforming.is_some_and(|(one, _)| !one.constraints.is_empty()) {
            return DVec3::ZERO;
        }
        let along = match body.guide.as_deref() {
            Some(&guide) if guide.dot(normal).abs() < LEAST_ALONG_GUIDE => DVec3::ZERO,
            Some(&guide) => guide * guide.dot(normal),
            None => normal,
        };
        body.inverse_mass() * along
    }

    /// One sweep; returns the pairs that overlapped too much before it, and the largest overlap that it has reduced over the
    /// allowed one.
    fn push_apart(&mut self, resolver: &mut Resolver) -> Result<(Vec<Overlap>, f64)> {
        let (mut found, mut largest) = (Vec::new(), 0.0);
        let mut image = Placed::default();
        for index in 0..self.pairs.len() {
            let pair = &mut self.pairs[index];
            let blocks = pair
                .parts
                .map(|part| self.parts.block[part as usize] as usize);
            let [first, second] = pair.parts.map(|part| &self.parts.placed[part as usize]);
            let periods = self.periods.as_ref();
            let image_shift =
                periods.map_or(DVec3::ZERO, |periods| periods.period.shift(pair.offset));
            image.copy_moved(second, image_shift);
            let Verdict::Contact(contact) = resolver.resolve(first, &image, &mut pair.cache)?
            else {
                continue;
            };
            let most = DISTANCES_PER_LIMIT * self.start_overlap * contact.limit;
            if contact.overlap > most {
                found.push(Overlap {
                    first: self.label(blocks[0]),
                    second: self.label(blocks[1]),
                    depth: contact.overlap,
                });
            }
            if contact.overlap <= TOUCHING * most {
                continue;
            }
            // They stay in contact.
            let (normal, distance) = match contact.overlap.is_finite() {
                true => (contact.normal, contact.overlap - 0.5 * TOUCHING * most),
                false => {
                    let down = self.gravity.try_normalize().unwrap_or(DVec3::NEG_Z);
                    (down, DISTANCES_PER_LIMIT * contact.limit)
                }
            };
            let mobility = blocks.map(|block| self.mobility(block, normal));
            let both = mobility[0] + mobility[1];
            if both == DVec3::ZERO {
                continue;
            }
            largest = f64::max(largest, contact.overlap / most);
            for (k, sign) in [(0, -1.0), (1, 1.0)] {
                let block = blocks[k];
                self.states[block].centre += mobility[k] * (sign * distance / both.dot(normal));
                let body = &self.bodies[block];
                let pose = pose(body, &self.states[block], &self.deforming.strains);
                self.parts.place_block(body, &pose);
            }
        }
        Ok((found, largest))
    }
}
