//! The convex parts of all blocks where they are now.

use super::{
    Body,
    body::State,
    deforming::{Strain, pose},
    step::BLOCKS_PER_TASK,
};
use crate::{
    geometry::{Form, Pose},
    rock::{broadphase::Aabb, contact::Placed},
};
use glam::DVec3;
use rayon::prelude::*;

/// All parts of all blocks, in order.
#[derive(Clone, Debug, Default)]
pub(super) struct PlacedParts {
    /// Block of each part.
    pub block: Vec<u32>,
    pub placed: Vec<Placed>,
}

impl PlacedParts {
    pub fn new(bodies: &[Body]) -> Self {
        let mut parts = Self::default();
        for (i, body) in bodies.iter().enumerate() {
            for _ in body.parts.clone() {
                parts.block.push(i as u32);
                parts.placed.push(Placed::default());
            }
        }
        parts
    }

    /// The boxes of all parts, each grown by the room of its block (m). What forces do not move is one
    /// group.
    pub fn aabbs(&self, bodies: &[Body], skin_margin: impl Fn(usize) -> f64) -> Vec<Aabb> {
        let immovable = bodies.len() as u32;
        let aabb = |(placed, &block): (&Placed, &u32)| {
            let (min, max) = bounds(placed);
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

    /// Moves the parts of the blocks that move.
    pub fn place_moving(&mut self, bodies: &[Body], states: &[State], strains: &[Strain]) {
        let all = self.placed.par_iter_mut().zip(&self.block).enumerate();
        all.with_min_len(BLOCKS_PER_TASK)
            .for_each(|(index, (placed, &block))| {
                let (body, state) = (&bodies[block as usize], &states[block as usize]);
                if !body.is_fixed() && !state.asleep {
                    place(body, index, &pose(body, state, strains), placed);
                }
            });
    }

    /// Puts all parts where their blocks are.
    pub fn place_all(&mut self, bodies: &[Body], states: &[State], strains: &[Strain]) {
        let all = self.placed.iter_mut().zip(&self.block).enumerate();
        for (index, (placed, &block)) in all {
            let (body, state) = (&bodies[block as usize], &states[block as usize]);
            place(body, index, &pose(body, state, strains), placed);
        }
    }

    /// Puts the parts of one block where it is.
    pub fn place_block(&mut self, body: &Body, pose: &Pose) {
        let own = self.placed[body.parts.clone()].iter_mut();
        for (index, placed) in body.parts.clone().zip(own) {
            place(body, index, pose, placed);
        }
    }
}

/// Moves one part, the `index`th of all.
fn place(body: &Body, index: usize, pose: &Pose, placed: &mut Placed) {
    let part = &body.shape.parts()[index - body.parts.start];
    match &part.form {
        Form::Convex(shape) => placed.update(shape, part.offset, pose),
        Form::Sphere { radius } => placed.update_sphere(*radius, part.offset, pose),
    }
}

/// Corners of the box along the axes around a part, m.
fn bounds(placed: &Placed) -> (DVec3, DVec3) {
    if placed.faces.is_empty() {
        let r = DVec3::splat(placed.radius);
        return (placed.centre - r, placed.centre + r);
    }
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for &v in &placed.vertices {
        min = min.min(v);
        max = max.max(v);
    }
    (placed.centre + min, placed.centre + max)
}
