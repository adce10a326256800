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

impl Blocks {
    /// Pushes overlapping blocks apart along their contact normals, pair after pair, until no overlap exceeds
    /// [`Setup::start_overlap`](super::Setup::start_overlap). The blocks of a pair move in inverse proportion to their
    /// masses; blocks with the same centre, whose contact has no normal, along gravity. No block rotates, fixed and driven
    /// blocks do not move, and velocities do not change.
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
        for sweep in 0..=sweeps {
            if self.needs_pairs() {
                let pairs = broadphase.pairs(&self.aabbs()).await?;
                self.set_pairs(pairs)?;
            }
            left = self.push_apart(&mut resolver)?;
            if left.is_empty() {
                return Ok(sweep);
            }
        }
        left.sort_by(|a, b| b.depth.total_cmp(&a.depth));
        Err(Error::Overlaps { pairs: left })
    }

    /// One sweep; returns the pairs that overlapped too much before it.
    fn push_apart(&mut self, resolver: &mut Resolver) -> Result<Vec<Overlap>> {
        let mut found = Vec::new();
        let mut image = Placed::default();
        for index in 0..self.pairs.len() {
            let pair = &mut self.pairs[index];
            let blocks = pair
                .parts
                .map(|part| self.parts.block[part as usize] as usize);
            // Blocks with fixed points do not move either.
            let inverse = blocks.map(|block| {
                let body = &self.bodies[block];
                let constrained = self
                    .deforming
                    .of(body)
                    .is_some_and(|(one, _)| !one.constraints.is_empty());
                if constrained {
                    0.0
                } else {
                    body.inverse_mass()
                }
            });
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
            if contact.overlap <= most {
                continue;
            }
            found.push(Overlap {
                first: self.label(blocks[0]),
                second: self.label(blocks[1]),
                depth: contact.overlap,
            });
            if inverse == [0.0; 2] {
                continue;
            }
            // Half the allowed overlap remains, so that neighbours in contact stay in contact.
            let (normal, distance) = match contact.overlap.is_finite() {
                true => (contact.normal, contact.overlap - 0.5 * most),
                false => {
                    let down = self.gravity.try_normalize().unwrap_or(DVec3::NEG_Z);
                    (down, DISTANCES_PER_LIMIT * contact.limit)
                }
            };
            for (k, sign) in [(0, -1.0), (1, 1.0)] {
                let share = inverse[k] / (inverse[0] + inverse[1]);
                let block = blocks[k];
                self.states[block].centre += normal * (sign * share * distance);
                let body = &self.bodies[block];
                let pose = pose(body, &self.states[block], &self.deforming.strains);
                self.parts.place_block(body, &pose);
            }
        }
        Ok(found)
    }
}
