//! Blocks that move so far in a step that they could pass through others unseen.

use super::{Blocks, Body, body::State, deforming::DeformingBlocks, step::BLOCKS_PER_TASK};
use crate::{Error, Result, geometry::Form};
use glam::{DMat3, DVec3};
use rayon::prelude::*;

/// Largest travel in a step as a share of the width of the block along its velocity: an obstacle, however thin, then
/// touches it before its middle has passed.
const LARGEST_TRAVEL: f64 = 0.5;

/// Share of its radius by which a block may move without a look at its width: half the width of the thinnest.
const NEGLIGIBLE_TRAVEL: f64 = 2e-4;

impl Blocks {
    /// Refuses a step of `dt` (s), which has been computed, if a block leaps in it.
    pub(super) fn check_tunnelling(&self, dt: f64) -> Result<()> {
        let alone = self.bodies.len() < 2 && self.periods.is_none();
        if alone || !self.bodies.iter().any(Body::is_free) {
            // There is nothing that it could touch.
            return Ok(());
        }
        let all = self.bodies.par_iter().zip(&self.states);
        let all = all.zip(&self.next_states).enumerate();
        let tunnelling =
            all.with_min_len(BLOCKS_PER_TASK)
                .filter_map(|(i, ((body, state), next))| {
                    let travel = next.centre - state.centre;
                    let length = travel.length();
                    if length <= NEGLIGIBLE_TRAVEL * body.radius {
                        return None;
                    }
                    let width = width(body, state, &self.deforming, travel / length);
                    (length > LARGEST_TRAVEL * width).then_some((i, length, width))
                });
        let Some((block, travel, width)) = tunnelling.min_by_key(|found| found.0) else {
            return Ok(());
        };
        let message = format!(
            "at {:.3e} m/s it moves {travel:.3e} m in a step of {dt:.3e} s, more than half of the {width:.3e} m that it is \
             wide along its velocity, and could pass through others unseen; take a time_step of at most {:.3e} s, or look \
             at what makes it so fast",
            travel / dt,
            dt * LARGEST_TRAVEL * width / travel
        );
        Err(Error::argument(self.label(block), message))
    }
}

/// Width of a block along a unit vector, m.
fn width(body: &Body, state: &State, deforming: &DeformingBlocks, along: DVec3) -> f64 {
    let deformation = match deforming.of(body) {
        Some((_, strain)) => strain.deformation,
        None => DMat3::from_quat(state.rotation),
    };
    // F X along d is X along Fᵀ d.
    let along = deformation.transpose() * along;
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut extend = |from: f64, to: f64| (low, high) = (low.min(from), high.max(to));
    for part in body.shape.parts() {
        let centre = along.dot(part.offset);
        match &part.form {
            Form::Sphere { radius } => extend(centre - radius, centre + radius),
            Form::Convex(polyhedron) => {
                for vertex in polyhedron.vertices() {
                    let at = centre + along.dot(*vertex);
                    extend(at, at);
                }
            }
        }
    }
    high - low
}
