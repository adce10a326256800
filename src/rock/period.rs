//! Periodic domains, and the images of blocks in them.
//!
//! Blocks keep unwrapped world coordinates, any number of periods away. The broadphase gets each part in
//! the first period and, if its box reaches other boxes there, its images in adjacent periods. A pair is two parts and the
//! number of periods by which the second is shifted to its image near the first.

use super::{Block, Body, body::State};
use crate::{
    Error, Result,
    geometry::{Form, HalfSpace, Part},
    rock::{broadphase::Aabb, integrate::Principal},
};
use glam::DVec3;

/// Length of a block in periods above which it counts as longer than the period: 1 plus the rounding of f32 coordinates of meshes.
const FILLED: f64 = 1.0 + 1e-6;

/// Gap between a face of a block and the opposite face of its image, in periods, below which the block does not turn about
/// other axes: contacts of a block with its own images are not computed.
const SELF_GAP: f64 = 0.01;

/// A box that is periodic along some axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Period {
    /// Lower corner, m.
    pub origin: DVec3,
    /// Edges, m; infinite along axes that are not periodic.
    pub size: DVec3,
}

impl Period {
    /// Whether an axis is periodic.
    fn repeats(&self, axis: usize) -> bool {
        self.size[axis].is_finite()
    }

    /// Shift by a number of periods, m.
    pub(super) fn shift(&self, offset: [i32; 3]) -> DVec3 {
        let shift = |axis: usize| match offset[axis] {
            0 => 0.0,
            offset => f64::from(offset) * self.size[axis],
        };
        DVec3::new(shift(0), shift(1), shift(2))
    }

    /// Number of periods from the first period to that of a point.
    fn offset(&self, place: DVec3) -> [i32; 3] {
        [0, 1, 2].map(|axis| match self.repeats(axis) {
            true => ((place[axis] - self.origin[axis]) / self.size[axis]).floor() as i32,
            false => 0,
        })
    }

    /// A point moved into the first period, m.
    pub(crate) fn wrapped(&self, place: DVec3) -> DVec3 {
        place - self.shift(self.offset(place))
    }

    /// Shift to the nearest image of a point at the distance vector `separation` (m) from another point, m.
    pub fn nearest(&self, separation: DVec3) -> DVec3 {
        let offset = [0, 1, 2].map(|axis| match self.repeats(axis) {
            true => -(separation[axis] / self.size[axis]).round() as i32,
            false => 0,
        });
        self.shift(offset)
    }

    /// Shifts to the images of a point, at the distance vector `separation` (m) from another point, that are within `range`
    /// (m) of that point along each axis, m: the nearest image, and at most one on each side of it.
    pub(crate) fn image_shifts(&self, separation: DVec3, range: f64) -> Vec<DVec3> {
        let nearest = self.nearest(separation);
        let mut image_shifts = vec![nearest];
        for axis in (0..3).filter(|axis| self.repeats(*axis)) {
            for side in [-1.0, 1.0] {
                let step = DVec3::AXES[axis] * (side * self.size[axis]);
                if (separation + nearest + step)[axis].abs() <= range {
                    let more = image_shifts
                        .iter()
                        .filter(|shift| shift[axis] == nearest[axis]);
                    let more: Vec<_> = more.map(|shift| *shift + step).collect();
                    image_shifts.extend(more);
                }
            }
        }
        image_shifts
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

    /// Axes along which a body is longer than the period at the start. A fixed body of this length is the same in all periods.
    ///
    /// # Errors
    /// [`Error::Argument`] if such a body can move: it would overlap its own image.
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
                "it is {} m long along {name}, where space repeats after {period} m, and would overlap its own image; make \
                 it at most that long, or the domain longer, or fix it",
                extent[axis]
            );
            return Err(Error::argument(label, message));
        }
        Ok(filled)
    }
}

impl Period {
    /// Axes along which plane faces of a block at both ends, at `low` and `high` (m), meet those of its own images.
    fn meets_itself(&self, block: &Block, [low, high]: [DVec3; 2]) -> [bool; 3] {
        let faces = |part: &Part| match &part.form {
            Form::Convex(of) => of
                .faces()
                .iter()
                .map(|f| f.seen_from(-part.offset))
                .collect(),
            Form::Sphere { .. } => Vec::new(),
        };
        let faces: Vec<HalfSpace> = block.shape.parts().iter().flat_map(faces).collect();
        [0, 1, 2].map(|axis| {
            let near = SELF_GAP * self.size[axis];
            let is_end = |out: DVec3, at: f64| {
                faces.iter().any(|face| {
                    let distance = out.dot(block.centre) + face.distance;
                    out.dot(block.rotation * face.normal) > 1.0 - 1e-9 && (at - distance) < near
                })
            };
            self.size[axis] - (high[axis] - low[axis]) < near
                && is_end(DVec3::AXES[axis], high[axis])
                && is_end(-DVec3::AXES[axis], -low[axis])
        })
    }

    /// The inertia tensor (kg m²) of a free rigid block that meets its own images along some axes; `None` if it meets none.
    ///
    /// # Errors
    /// [`Error::Argument`] if the block starts to turn into its image.
    pub(super) fn held(
        &self,
        block: &Block,
        ends: [DVec3; 2],
        label: &str,
    ) -> Result<Option<Principal>> {
        let meets = self.meets_itself(block, ends);
        let own = |axis: usize| block.rotation.inverse() * DVec3::AXES[axis];
        let axis = match meets {
            [false, false, false] => return Ok(None),
            [true, false, false] => Some(0),
            [false, true, false] => Some(1),
            [false, false, true] => Some(2),
            _ => None,
        };
        let along = axis.map_or(DVec3::ZERO, |axis| DVec3::AXES[axis]);
        if block.spin != along * along.dot(block.spin) {
            let turns = axis.map_or("not at all", |axis| {
                ["only about x", "only about y", "only about z"][axis]
            });
            let message = format!(
                "its faces meet those of its own periodic images, so that it turns {turns}, and its spin is {} rad/s; make \
                 the domain longer, or correct the spin",
                block.spin
            );
            return Err(Error::argument(label, message));
        }
        Ok(Some(Principal::held(block.shape.inertia(), axis.map(own))))
    }
}

/// A part at its position for the broadphase.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Image {
    pub part: u32,
    /// Number of periods by which it is moved back.
    pub offset: [i32; 3],
}

/// The period, and the axes along which blocks fill it.
#[derive(Clone, Debug)]
pub(crate) struct Periods {
    pub period: Period,
    /// Axes along which each block is longer than the period and has no images.
    pub filled: Vec<[bool; 3]>,
}

impl Periods {
    /// Moves the boxes of all parts into the period, and adds their images in the neighbouring periods that reach the
    /// region of the boxes. `block`: block of each part.
    pub(super) fn images(
        &self,
        states: &[State],
        block: &[u32],
        aabbs: &mut Vec<Aabb>,
    ) -> Vec<Image> {
        let mut images: Vec<Image> = Vec::with_capacity(aabbs.len());
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for ((part, aabb), &block) in (0..).zip(aabbs.iter_mut()).zip(block) {
            let offset = self.period.offset(states[block as usize].centre);
            *aabb = moved(aabb, -self.period.shift(offset));
            images.push(Image { part, offset });
            let filled = self.filled[block as usize];
            for axis in (0..3).filter(|&axis| !filled[axis]) {
                low[axis] = low[axis].min(aabb.min[axis]);
                high[axis] = high[axis].max(aabb.max[axis]);
            }
        }
        for n in 0..block.len() {
            let (aabb, image) = (aabbs[n], images[n]);
            let filled = self.filled[block[n] as usize];
            let image_shifts = |axis: usize| -> &[i32] {
                match self.period.repeats(axis) && !filled[axis] {
                    true => &[0, 1, -1],
                    false => &[0],
                }
            };
            for &x in image_shifts(0) {
                for &y in image_shifts(1) {
                    for &z in image_shifts(2) {
                        let shift = self.period.shift([x, y, z]);
                        let there = moved(&aabb, shift);
                        let reaches = (0..3).all(|axis| {
                            shift[axis] == 0.0
                                || there.min[axis] <= high[axis] && low[axis] <= there.max[axis]
                        });
                        if shift != DVec3::ZERO && reaches {
                            aabbs.push(there);
                            let [a, b, c] = image.offset;
                            images.push(Image {
                                part: image.part,
                                offset: [a - x, b - y, c - z],
                            });
                        }
                    }
                }
            }
        }
        images
    }

    /// Shifts, m, to those images of the second of two blocks, at `separation` (m) from the first, that are within `range`
    /// (m) of the first along each axis. Along an axis that one of the blocks fills, only the shift to the nearest image,
    /// since the filling block is the same in all periods.
    pub(crate) fn image_shifts(
        &self,
        blocks: [usize; 2],
        separation: DVec3,
        range: f64,
    ) -> Vec<DVec3> {
        let filled = |axis: usize| blocks.iter().any(|&block| self.filled[block][axis]);
        let nearest = self.period.nearest(separation);
        let mut image_shifts = self.period.image_shifts(separation, range);
        image_shifts
            .retain(|shift| (0..3).all(|axis| !filled(axis) || shift[axis] == nearest[axis]));
        image_shifts
    }

    /// The components of a periodic offset that identify a pair while a block crosses the boundary: those along
    /// axes that neither block fills.
    pub(super) fn lasting(&self, blocks: [u32; 2], offset: [i32; 3]) -> [i32; 3] {
        let [a, b] = blocks.map(|block| self.filled[block as usize]);
        std::array::from_fn(|axis| if a[axis] || b[axis] { 0 } else { offset[axis] })
    }
}

pub(super) fn moved(aabb: &Aabb, shift: DVec3) -> Aabb {
    let by = |corner: [f64; 3]| std::array::from_fn(|axis| corner[axis] + shift[axis]);
    Aabb {
        min: by(aabb.min),
        max: by(aabb.max),
        ..*aabb
    }
}
