//! The boxes in which pairs are looked for, and the pairs that are found.

use super::{
    Blocks, Period,
    body::State,
    pairs::{self, Mark},
    period::{Image, Periods},
};
#[cfg(doc)]
use crate::{Error, rock::broadphase::Broadphase};
use crate::{Result, rock::broadphase::Item};
use glam::DVec3;

impl Blocks {
    /// Boxes of all parts for a [`Broadphase`], grown by half the skin, those of fast blocks by more, and by
    /// half the range of the films. Where space repeats, they are in the period, and the images that reach others follow.
    pub fn items(&self) -> Vec<Item> {
        let mut items = self.boxes();
        if let Some(periods) = &self.periods {
            periods.images(&self.states, &self.parts.block, &mut items);
        }
        items
    }

    /// The boxes where the blocks are.
    fn boxes(&self) -> Vec<Item> {
        let thin = self.film.as_ref().map_or(0.0, |film| 0.5 * film.reach());
        self.parts
            .items(&self.bodies, |block| self.room(block) + thin)
    }

    /// The period of the setup with what the blocks fill of it.
    pub(super) fn repeated(&self, period: Period) -> Result<Periods> {
        let boxes = self.parts.items(&self.bodies, |_| 0.0);
        let filled = self.bodies.iter().enumerate().map(|(block, body)| {
            let own = boxes[body.parts.clone()].iter();
            let around = own.fold(
                [DVec3::INFINITY, DVec3::NEG_INFINITY],
                |[low, high], item| [low.min(item.min.into()), high.max(item.max.into())],
            );
            period.filled(body, around, &self.label(block))
        });
        Ok(Periods {
            period,
            filled: filled.collect::<Result<_>>()?,
        })
    }

    /// Where space repeats.
    pub fn period(&self) -> Option<Period> {
        self.periods.as_ref().map(|periods| periods.period)
    }

    /// Ways by which the second of two blocks is to be moved that is `apart` (m) from the first, to be within `near` (m) of it
    /// along each axis, m; along axes of which one fills the period only that to the nearest, as the others lie in it.
    pub(crate) fn ways(&self, blocks: [usize; 2], apart: DVec3, near: f64) -> Vec<DVec3> {
        let Some(periods) = &self.periods else {
            return vec![DVec3::ZERO];
        };
        let filled = |axis: usize| blocks.iter().any(|&block| periods.filled[block][axis]);
        let nearest = periods.period.nearest(apart);
        let mut ways = periods.period.ways(apart, near);
        ways.retain(|way| (0..3).all(|axis| !filled(axis) || way[axis] == nearest[axis]));
        ways
    }

    /// Of each of [`Blocks::items`] its part and the way by which it is moved, m.
    pub(crate) fn images(&self) -> Vec<(usize, DVec3)> {
        let Some(periods) = &self.periods else {
            return (0..self.parts.block.len())
                .map(|part| (part, DVec3::ZERO))
                .collect();
        };
        let seen = self.seen(periods).into_iter();
        seen.map(|image| (image.part as usize, -periods.period.way(image.turns)))
            .collect()
    }

    /// The images of all items.
    fn seen(&self, periods: &Periods) -> Vec<Image> {
        periods.images(&self.states, &self.parts.block, &mut self.boxes())
    }

    /// Whether a step needs a new list of pairs first: a block has moved, or will in this step, by half
    /// the skin.
    pub fn wants_pairs(&self) -> bool {
        self.marks.len() < self.bodies.len()
            || pairs::outlived(
                &self.bodies,
                &self.states,
                &self.deforming,
                &self.marks,
                self.ahead(),
            )
    }

    /// The pairs of [`Blocks::items`] that may touch. What the pairs remember of each other stays.
    ///
    /// # Errors
    /// [`Error::Argument`] if they are not sorted pairs of items.
    pub fn set_pairs(&mut self, pairs: Vec<[u32; 2]>) -> Result<()> {
        let block = &self.parts.block;
        let images = self.periods.as_ref().map(|periods| self.seen(periods));
        let pairs = pairs::checked(pairs, images.as_deref(), block, &self.bodies)?;
        self.pairs = pairs::merged(&self.pairs, &pairs, |parts, turns| {
            let blocks = parts.map(|part| block[part as usize]);
            let periods = self.periods.as_ref();
            periods.map_or(turns, |periods| periods.lasting(blocks, turns))
        });
        let mark = |(i, state): (usize, &State)| Mark {
            centre: state.centre,
            rotation: state.rotation,
            room: self.room(i),
        };
        self.marks = self.states.iter().enumerate().map(mark).collect();
        self.deforming.mark();
        Ok(())
    }

    /// By how much the boxes of a block are grown, m.
    fn room(&self, block: usize) -> f64 {
        let (body, state) = (&self.bodies[block], &self.states[block]);
        pairs::room(body, state, &self.deforming, self.skin, self.ahead())
    }

    /// Time for which pairs must be known ahead, s.
    fn ahead(&self) -> f64 {
        // Without free blocks no step is too long, and there are no pairs.
        if self.time_step.is_finite() {
            self.time_step
        } else {
            0.0
        }
    }
}
