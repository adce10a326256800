//! Space that repeats, and the images of blocks in it.
//!
//! Blocks go on in the coordinates of the world, however many periods away. A search for pairs sees each part in
//! the one period and, where its box reaches a neighbour's, its images in the next ones; a pair is two parts and the
//! number of periods by which the second is moved to be beside the first.

use super::{Body, body::State};
use crate::{Error, Result, rock::broadphase::Item};
use glam::DVec3;

/// How far beyond a period a block may reach and count as one that fills it: the rounding of scenes.
const FILLED: f64 = 1.0 + 1e-9;

/// A box that repeats along some axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Period {
    /// Lower corner, m.
    pub origin: DVec3,
    /// Edges, m; infinite along axes that do not repeat.
    pub size: DVec3,
}

impl Period {
    /// Whether space repeats along an axis.
    fn repeats(&self, axis: usize) -> bool {
        self.size[axis].is_finite()
    }

    /// Way of a number of periods, m.
    pub(super) fn way(&self, turns: [i32; 3]) -> DVec3 {
        let way = |axis: usize| match turns[axis] {
            0 => 0.0,
            turns => f64::from(turns) * self.size[axis],
        };
        DVec3::new(way(0), way(1), way(2))
    }

    /// Number of periods that a place is away.
    fn turns(&self, place: DVec3) -> [i32; 3] {
        [0, 1, 2].map(|axis| match self.repeats(axis) {
            true => ((place[axis] - self.origin[axis]) / self.size[axis]).floor() as i32,
            false => 0,
        })
    }

    /// A place moved into the one period, m.
    pub(crate) fn within(&self, place: DVec3) -> DVec3 {
        place - self.way(self.turns(place))
    }

    /// Way by which something is to be moved that is `apart` (m) from something else, to be as near as it gets, m.
    pub fn nearest(&self, apart: DVec3) -> DVec3 {
        let turns = [0, 1, 2].map(|axis| match self.repeats(axis) {
            true => -(apart[axis] / self.size[axis]).round() as i32,
            false => 0,
        });
        self.way(turns)
    }

    /// All ways by which something is to be moved that is `apart` (m) from something else, to be within `near` (m) of it
    /// along each axis, m; that to its nearest image, and to one on each side of that at most.
    pub(crate) fn ways(&self, apart: DVec3, near: f64) -> Vec<DVec3> {
        let nearest = self.nearest(apart);
        let mut ways = vec![nearest];
        for axis in (0..3).filter(|axis| self.repeats(*axis)) {
            for turn in [-1.0, 1.0] {
                let step = DVec3::AXES[axis] * (turn * self.size[axis]);
                if (apart + nearest + step)[axis].abs() <= near {
                    let more = ways.iter().filter(|way| way[axis] == nearest[axis]);
                    let more: Vec<_> = more.map(|way| *way + step).collect();
                    ways.extend(more);
                }
            }
        }
        ways
    }

    /// # Errors
    /// [`Error::Argument`] if an edge is not positive.
    pub(super) fn check(&self) -> Result<()> {
        if self.origin.is_finite() && self.size.min_element() > 0.0 {
            return Ok(());
        }
        let message = format!(
            "a period of {} m from {} m: edges must be greater than 0, infinite where nothing repeats",
            self.size, self.origin
        );
        Err(Error::argument("period", message))
    }

    /// Along which axes a body at the start fills more than the period. What is fixed then is the same in all of them.
    ///
    /// # Errors
    /// [`Error::Argument`] if it can move, so that it would be in its own way.
    pub(super) fn filled(
        &self,
        body: &Body,
        [low, high]: [DVec3; 2],
        label: &str,
    ) -> Result<[bool; 3]> {
        let extent = high - low;
        let filled = [0, 1, 2].map(|axis| extent[axis] > self.size[axis] * FILLED);
        if let Some(axis) = (0..3).find(|&axis| filled[axis] && !body.is_fixed()) {
            let (name, period) = (["x", "y", "z"][axis], self.size[axis]);
            let message = format!(
                "it is {} m long along {name}, where space repeats after {period} m, and would be in its own way; make \
                 it at most that long, or the domain longer, or fix it",
                extent[axis]
            );
            return Err(Error::argument(label, message));
        }
        Ok(filled)
    }
}

/// A part where a search sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Image {
    pub part: u32,
    /// Periods by which it is moved back.
    pub turns: [i32; 3],
}

/// The periods of all blocks.
#[derive(Clone, Debug)]
pub(super) struct Periods {
    pub period: Period,
    /// Axes along which a block fills more than the period and has no images.
    pub filled: Vec<[bool; 3]>,
}

impl Periods {
    /// Moves the boxes of all parts into the period and adds their images in the neighbouring ones, as far as they
    /// reach another box there. `block`: that of each part.
    pub fn images(&self, states: &[State], block: &[u32], items: &mut Vec<Item>) -> Vec<Image> {
        let mut images: Vec<Image> = Vec::with_capacity(items.len());
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for ((part, item), &block) in (0..).zip(items.iter_mut()).zip(block) {
            let turns = self.period.turns(states[block as usize].centre);
            *item = moved(item, -self.period.way(turns));
            images.push(Image { part, turns });
            let filled = self.filled[block as usize];
            for axis in (0..3).filter(|&axis| !filled[axis]) {
                low[axis] = low[axis].min(item.min[axis]);
                high[axis] = high[axis].max(item.max[axis]);
            }
        }
        for n in 0..block.len() {
            let (item, image) = (items[n], images[n]);
            let filled = self.filled[block[n] as usize];
            let ways = |axis: usize| -> &[i32] {
                match self.period.repeats(axis) && !filled[axis] {
                    true => &[0, 1, -1],
                    false => &[0],
                }
            };
            for &x in ways(0) {
                for &y in ways(1) {
                    for &z in ways(2) {
                        let way = self.period.way([x, y, z]);
                        let there = moved(&item, way);
                        let reaches = (0..3).all(|axis| {
                            way[axis] == 0.0
                                || there.min[axis] <= high[axis] && low[axis] <= there.max[axis]
                        });
                        if way != DVec3::ZERO && reaches {
                            items.push(there);
                            let [a, b, c] = image.turns;
                            images.push(Image {
                                part: image.part,
                                turns: [a - x, b - y, c - z],
                            });
                        }
                    }
                }
            }
        }
        images
    }

    /// What stays the same of the periods between two blocks while one of them goes through the border: those along
    /// axes that neither fills.
    pub fn lasting(&self, blocks: [u32; 2], turns: [i32; 3]) -> [i32; 3] {
        let [a, b] = blocks.map(|block| self.filled[block as usize]);
        std::array::from_fn(|axis| if a[axis] || b[axis] { 0 } else { turns[axis] })
    }
}

fn moved(item: &Item, way: DVec3) -> Item {
    let by = |corner: [f64; 3]| std::array::from_fn(|axis| corner[axis] + way[axis]);
    Item {
        min: by(item.min),
        max: by(item.max),
        ..*item
    }
}
