//! Candidate pairs: the parts and boxes that a broadphase searches, the list of pairs, and how long the list stays complete.

use super::{
    Block, Blocks, Body, Period,
    body::State,
    contact_list::NO_CONTACT,
    deforming::{DeformingBlocks, RIGID, Strain, pose},
    period::{Image, Periods, moved},
    threads::{self, each_block},
};
#[cfg(doc)]
use crate::rock::broadphase::Broadphase;
use crate::{
    Error, Result,
    geometry::{Form, Pose, bounding_box},
    rock::{
        broadphase::Aabb,
        contact::{Cache, Placed},
    },
};
use glam::{DQuat, DVec3};
use rayon::prelude::*;

/// A candidate pair.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct CandidatePair {
    /// First and second part, in ascending order.
    pub parts: [u32; 2],
    /// Number of periods by which the second part is shifted to its image near the first.
    pub offset: [i32; 3],
    /// Cache of the resolver.
    pub cache: Cache,
    /// Index of its contact among all contacts, or [`NO_CONTACT`].
    pub contact: u32,
}

impl CandidatePair {
    pub fn new(parts: [u32; 2], offset: [i32; 3]) -> Self {
        Self {
            parts,
            offset,
            cache: Cache::default(),
            contact: NO_CONTACT,
        }
    }

    fn part_pair(&self) -> PartPair {
        PartPair {
            parts: self.parts,
            offset: self.offset,
        }
    }
}

/// Pose of a block when the list was made, and the displacement that the list allows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct SkinReference {
    pub centre: DVec3,
    pub rotation: DQuat,
    /// Margin of its boxes, m.
    pub skin_margin: f64,
}

impl SkinReference {
    /// Upper bound of the displacement of all points of the block, m.
    fn moved(&self, body: &Body, state: &State, deforming: &DeformingBlocks) -> f64 {
        let travel = (state.centre - self.centre).length();
        if let Some(moved_by_strain) = deforming.moved_by_strain(body) {
            return travel + moved_by_strain;
        }
        let rotation = state.rotation * self.rotation.conjugate();
        // A point at the distance r from the axis moves by 2 r sin(θ/2).
        travel + 2.0 * rotation.xyz().length() * body.radius
    }
}

/// Margin of the boxes of a block: half the skin, or the distance that a fast block travels in two steps, m.
fn skin_margin(body: &Body, state: &State, deforming: &DeformingBlocks, skin: f64, dt: f64) -> f64 {
    (0.5 * skin).max(2.0 * step_travel(body, state, deforming, dt))
}

/// Distance that the fastest point travels in a step, m.
fn step_travel(body: &Body, state: &State, deforming: &DeformingBlocks, dt: f64) -> f64 {
    if body.is_fixed() || state.asleep {
        return 0.0;
    }
    deforming.fastest(body, state) * dt
}

/// Whether any block may leave its boxes within a step, so that pairs may be missing.
fn skin_exceeded(
    bodies: &[Body],
    states: &[State],
    deforming: &DeformingBlocks,
    skin_references: &[SkinReference],
    dt: f64,
) -> bool {
    let all = each_block(bodies, bodies.len()).zip(states);
    let all = all.zip(skin_references);
    all.filter(|((body, state), _)| !body.is_fixed() && !state.asleep)
        .any(|((body, state), reference)| {
            let step_travel = step_travel(body, state, deforming, dt);
            reference.moved(body, state, deforming) + step_travel > reference.skin_margin
        })
}

/// The list of `new` pairs, with the caches and contacts of the `old` list. An old pair in contact that is not in `new`
/// is kept: its history ends only when the resolver finds no contact.
///
/// `lasting`: the components of the periodic offset that identify a pair, see [`Periods::lasting`].
fn merged(
    old: &[CandidatePair],
    new: &[PartPair],
    lasting: impl Fn(&PartPair) -> [i32; 3],
) -> Vec<CandidatePair> {
    let mut list = Vec::with_capacity(new.len());
    let mut rest = old.iter().copied().peekable();
    let key = |pair: PartPair| (pair.parts, lasting(&pair));
    for &PartPair { parts, offset } in new {
        let wanted = key(PartPair { parts, offset });
        while let Some(pair) = rest.next_if(|pair| key(pair.part_pair()) < wanted) {
            list.extend((pair.contact != NO_CONTACT).then_some(pair));
        }
        let kept = rest.next_if(|pair| key(pair.part_pair()) == wanted);
        list.push(kept.map_or_else(
            || CandidatePair::new(parts, offset),
            |pair| CandidatePair { offset, ..pair },
        ));
    }
    list.extend(rest.filter(|pair| pair.contact != NO_CONTACT));
    list
}

/// Two parts that may touch, and the periodic image of the second that may touch the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct PartPair {
    /// First and second part, in ascending order.
    pub parts: [u32; 2],
    /// Number of periods by which the second is shifted.
    pub offset: [i32; 3],
}

/// Converts pairs of boxes to pairs of parts, without pairs of one block and pairs of two blocks that forces
/// do not move. `images`: the part of each box; if `None`, box and part have the same number.
///
/// # Errors
/// If the list is not sorted, names a box that does not exist, or names a pair twice.
fn checked(
    pairs: Vec<[u32; 2]>,
    images: Option<&[Image]>,
    block: &[u32],
    bodies: &[Body],
) -> Result<Vec<PartPair>> {
    let aabbs = images.map_or(block.len(), <[Image]>::len);
    let known = |pair: &[u32; 2]| pair[0] < pair[1] && (pair[1] as usize) < aabbs;
    if let Some(pair) = pairs.iter().find(|pair| !known(pair)) {
        return Err(Error::argument(
            "pairs",
            format!("{pair:?} must be two of the {aabbs} boxes in ascending order"),
        ));
    }
    if !pairs.is_sorted_by(|a, b| a < b) {
        let message = "the broadphase must return the pairs sorted, each once";
        return Err(Error::argument("pairs", message));
    }
    let matters = |pair: &PartPair| {
        let [a, b] = pair.parts.map(|part| block[part as usize]);
        a != b && (bodies[a as usize].is_free() || bodies[b as usize].is_free())
    };
    let Some(images) = images else {
        let own = pairs.into_iter().map(|parts| PartPair {
            parts,
            offset: [0; 3],
        });
        return Ok(own.filter(matters).collect());
    };
    let part_pair = |pair: [u32; 2]| {
        let mut ends = pair.map(|aabb| images[aabb as usize]);
        ends.sort_unstable_by_key(|image| image.part);
        let [a, b] = ends;
        PartPair {
            parts: [a.part, b.part],
            offset: std::array::from_fn(|axis| a.offset[axis] - b.offset[axis]),
        }
    };
    let mut list: Vec<PartPair> = pairs.into_iter().map(part_pair).filter(matters).collect();
    // The same pair of parts may also be found as a pair of their images.
    list.sort_unstable();
    list.dedup();
    Ok(list)
}

/// A tenth of the mean radius of the moving parts: a small margin that still keeps the list valid for many steps.
pub(super) fn usual_skin(bodies: &[Body]) -> f64 {
    let moving = bodies.iter().filter(|body| !body.is_fixed());
    let (mut sum, mut count) = (0.0, 0.0f64);
    for part in moving.flat_map(|body| body.shape.parts()) {
        sum += part.form.radius();
        count += 1.0;
    }
    0.1 * sum / count.max(1.0)
}

impl Blocks {
    /// Boxes of all parts for a [`Broadphase`], grown by half the skin, for fast blocks by more, and by
    /// half the range of the films. In a periodic domain they are moved into the period, followed by the images that reach
    /// other boxes.
    pub fn aabbs(&self) -> Vec<Aabb> {
        let mut aabbs = self.part_aabbs();
        if let Some(periods) = &self.periods {
            periods.images(&self.states, &self.parts.block, &mut aabbs);
        }
        aabbs
    }

    /// The boxes of the parts at the present poses.
    fn part_aabbs(&self) -> Vec<Aabb> {
        let thin = self.film.as_ref().map_or(0.0, |film| 0.5 * film.reach());
        self.parts
            .aabbs(&self.bodies, |block| self.skin_margin(block) + thin)
    }

    /// The periods of the setup, with the axes that the blocks in `list` fill. Blocks that meet their own images are held.
    pub(super) fn repeat(&mut self, period: Period, list: &[Block]) -> Result<()> {
        let part_aabbs = self.parts.aabbs(&self.bodies, |_| 0.0);
        let mut filled = Vec::with_capacity(list.len());
        for (block, made) in list.iter().enumerate() {
            let body = &self.bodies[block];
            let own = part_aabbs[body.parts.clone()].iter();
            let corners = own.flat_map(|aabb| [aabb.min, aabb.max].map(DVec3::from));
            let (ends, label) = (bounding_box(corners), self.label(block));
            filled.push(period.filled(body, ends, &label)?);
            if body.is_free()
                && body.deforming == RIGID
                && let Some(held) = period.held(made, ends, &label)?
            {
                self.bodies[block].hold(held, &mut self.states[block]);
            }
        }
        self.periods = Some(Periods { period, filled });
        Ok(())
    }

    /// The periods of the domain.
    pub fn period(&self) -> Option<Period> {
        self.periods.as_ref().map(|periods| periods.period)
    }

    /// Periodic axes that a block fills, along which it has no images.
    pub(crate) fn filled(&self, block: usize) -> [bool; 3] {
        let periods = self.periods.as_ref();
        periods.map_or([false; 3], |periods| periods.filled[block])
    }

    /// The period, and the axes that blocks fill.
    pub(crate) fn periods(&self) -> Option<&Periods> {
        self.periods.as_ref()
    }

    /// Part of each of [`Blocks::aabbs`], and the shift of its image, m.
    pub(crate) fn images(&self) -> Vec<(usize, DVec3)> {
        let Some(periods) = &self.periods else {
            return (0..self.parts.block.len())
                .map(|part| (part, DVec3::ZERO))
                .collect();
        };
        let part_images = self.part_images(periods).into_iter();
        part_images
            .map(|image| (image.part as usize, -periods.period.shift(image.offset)))
            .collect()
    }

    /// The image of each box.
    fn part_images(&self, periods: &Periods) -> Vec<Image> {
        periods.images(&self.states, &self.parts.block, &mut self.part_aabbs())
    }

    /// Whether a step needs a new list of pairs first, because a block has moved by half the skin or will do so in this step.
    pub fn needs_pairs(&self) -> bool {
        self.skin_references.len() < self.bodies.len()
            || skin_exceeded(
                &self.bodies,
                &self.states,
                &self.deforming,
                &self.skin_references,
                self.pair_horizon(),
            )
    }

    /// Sets the candidate pairs, as indices of [`Blocks::aabbs`]. Known pairs keep their caches and contacts.
    ///
    /// # Errors
    /// [`Error::Argument`] if they are not sorted pairs of boxes.
    pub fn set_pairs(&mut self, pairs: Vec<[u32; 2]>) -> Result<()> {
        let block = &self.parts.block;
        let images = self
            .periods
            .as_ref()
            .map(|periods| self.part_images(periods));
        let mut pairs = checked(pairs, images.as_deref(), block, &self.bodies)?;
        if let Some(periods) = &self.periods {
            self.drop_repeated(periods, &mut pairs);
        }
        self.pairs = merged(&self.pairs, &pairs, |pair| {
            let blocks = pair.parts.map(|part| block[part as usize]);
            let periods = self.periods.as_ref();
            periods.map_or(pair.offset, |periods| periods.lasting(blocks, pair.offset))
        });
        let reference = |(i, state): (usize, &State)| SkinReference {
            centre: state.centre,
            rotation: state.rotation,
            skin_margin: self.skin_margin(i),
        };
        self.skin_references = self.states.iter().enumerate().map(reference).collect();
        self.deforming.set_skin_reference();
        Ok(())
    }

    /// Drops pairs with several images of a block next to one that fills an axis, which repeat the same contact: only that image
    /// is kept that lies next to the filling part with its whole length, if there is one. Sorts the pairs by their
    /// [`Periods::lasting`] offsets.
    fn drop_repeated(&self, periods: &Periods, pairs: &mut Vec<PartPair>) {
        if periods.filled.iter().all(|filled| *filled == [false; 3]) {
            return;
        }
        let blocks = |pair: &PartPair| pair.parts.map(|part| self.parts.block[part as usize]);
        let key = |pair: &PartPair| (pair.parts, periods.lasting(blocks(pair), pair.offset));
        let aabbs = self.parts.aabbs(&self.bodies, |_| 0.0);
        // Lengths by which the parts that do not fill an axis extend beyond those that do, and distance of the blocks, m.
        let excess = |pair: &PartPair| {
            let shift = periods.period.shift(pair.offset);
            let filled = blocks(pair).map(|block| periods.filled[block as usize]);
            let [first, mut second] = pair.parts.map(|part| aabbs[part as usize]);
            second = moved(&second, shift);
            let along = |axis: usize| {
                let (filling, other) = match [filled[0][axis], filled[1][axis]] {
                    [true, false] => (&first, &second),
                    [false, true] => (&second, &first),
                    _ => return 0.0,
                };
                (filling.min[axis] - other.min[axis]).max(0.0)
                    + (other.max[axis] - filling.max[axis]).max(0.0)
            };
            let [a, b] = blocks(pair).map(|block| self.states[block as usize].centre);
            (along(0) + along(1) + along(2), (b + shift).distance(a))
        };
        pairs.sort_by(|a, b| {
            key(a).cmp(&key(b)).then_with(|| {
                let ((a_length, a_distance), (b_length, b_distance)) = (excess(a), excess(b));
                let lengths = a_length.total_cmp(&b_length);
                lengths.then(a_distance.total_cmp(&b_distance))
            })
        });
        pairs.dedup_by(|next, first| key(next) == key(first) && excess(first).0 == 0.0);
    }

    /// Margin of the boxes of a block, m.
    fn skin_margin(&self, block: usize) -> f64 {
        let (body, state) = (&self.bodies[block], &self.states[block]);
        skin_margin(body, state, &self.deforming, self.skin, self.pair_horizon())
    }

    /// Time for which the list must remain complete, s.
    fn pair_horizon(&self) -> f64 {
        // Without free blocks the step is not limited, and there are no pairs.
        if self.time_step.is_finite() {
            self.time_step
        } else {
            0.0
        }
    }
}

/// All parts of all blocks, in order.
#[derive(Clone, Debug, Default)]
pub(super) struct PlacedParts {
    /// Block of each part.
    pub block: Vec<u32>,
    pub placed: Vec<Placed>,
    /// Whether there are spheres among them.
    pub has_spheres: bool,
}

impl PlacedParts {
    pub fn new(bodies: &[Body]) -> Self {
        let mut parts = Self::default();
        for (i, body) in bodies.iter().enumerate() {
            for part in body.shape.parts() {
                parts.block.push(i as u32);
                parts.placed.push(Placed::default());
                parts.has_spheres |= matches!(part.form, Form::Sphere { .. });
            }
        }
        parts
    }

    /// The boxes of all parts, each grown by the margin of its block (m). All parts that forces do not move form one
    /// group.
    pub fn aabbs(&self, bodies: &[Body], skin_margin: impl Fn(usize) -> f64) -> Vec<Aabb> {
        let immovable = bodies.len() as u32;
        let aabb = |(placed, &block): (&Placed, &u32)| {
            let [min, max] = bounds(placed);
            let grow = DVec3::splat(skin_margin(block as usize));
            let free = bodies[block as usize].is_free();
            Aabb {
                min: (min - grow).to_array(),
                max: (max + grow).to_array(),
                group: if free { block } else { immovable },
            }
        };
        self.placed.iter().zip(&self.block).map(aabb).collect()
    }

    /// Updates the parts of moving blocks.
    pub fn place_moving(&mut self, bodies: &[Body], states: &[State], strains: &[Strain]) {
        let moves = |block: usize| !bodies[block].is_fixed() && !states[block].asleep;
        let moving = || (0..bodies.len()).filter(|&block| moves(block));
        let parts: usize = moving().map(|block| bodies[block].parts.len()).sum();
        if parts < threads::PAIRS {
            for block in moving() {
                let pose = pose(&bodies[block], &states[block], strains);
                self.place_block(&bodies[block], &pose);
            }
            return;
        }
        let all = self.placed.par_iter_mut().zip(&self.block).enumerate();
        all.for_each(|(index, (placed, &block))| {
            let block = block as usize;
            if moves(block) {
                let pose = pose(&bodies[block], &states[block], strains);
                place(&bodies[block], index, &pose, placed);
            }
        });
    }

    /// Places all parts at the poses of their blocks.
    pub fn place_all(&mut self, bodies: &[Body], states: &[State], strains: &[Strain]) {
        let all = self.placed.iter_mut().zip(&self.block).enumerate();
        for (index, (placed, &block)) in all {
            let (body, state) = (&bodies[block as usize], &states[block as usize]);
            place(body, index, &pose(body, state, strains), placed);
        }
    }

    /// Places the parts of one block at its pose.
    pub fn place_block(&mut self, body: &Body, pose: &Pose) {
        let own = self.placed[body.parts.clone()].iter_mut();
        for (index, placed) in body.parts.clone().zip(own) {
            place(body, index, pose, placed);
        }
    }
}

/// Places one part, the `index`th of all.
fn place(body: &Body, index: usize, pose: &Pose, placed: &mut Placed) {
    let part = &body.shape.parts()[index - body.parts.start];
    match &part.form {
        Form::Convex(shape) => placed.update(shape, part.offset, pose),
        Form::Sphere { radius } => placed.update_sphere(*radius, part.offset, pose),
    }
}

/// Lower and upper corner of the axis-aligned bounding box of a part, m.
fn bounds(placed: &Placed) -> [DVec3; 2] {
    if placed.faces.is_empty() {
        let r = DVec3::splat(placed.radius);
        return [placed.centre - r, placed.centre + r];
    }
    bounding_box(placed.vertices.iter().copied()).map(|corner| placed.centre + corner)
}
