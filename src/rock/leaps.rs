//! Blocks that move so far in a step that they could pass through others unseen.

use super::{Blocks, Body, body::State, deforming::DeformingBlocks, step::FEW};
use crate::{Error, Result, geometry::Form};
use glam::{DMat3, DVec3};
use rayon::prelude::*;

/// Share of its width along its way by which a block may move in a step: what is in the way, however thin, then meets
/// it before its middle is through.
const FARTHEST: f64 = 0.5;

/// Share of its radius by which a block may move without a look at its width: half the width of the thinnest.
const SHORT: f64 = 2e-4;

impl Blocks {
    /// Refuses a step of `dt` (s), which has been computed, if a block leaps in it.
    pub(super) fn check_ways(&self, dt: f64) -> Result<()> {
        let alone = self.bodies.len() < 2 && self.periods.is_none();
        if alone || !self.bodies.iter().any(Body::is_free) {
            // There is nothing in the way that it could touch.
            return Ok(());
        }
        let all = self.bodies.par_iter().zip(&self.states);
        let all = all.zip(&self.next_states).enumerate();
        let leaps = all
            .with_min_len(FEW)
            .filter_map(|(i, ((body, state), next))| {
                let way = next.centre - state.centre;
                let length = way.length();
                if length <= SHORT * body.radius {
                    return None;
                }
                let width = width(body, state, &self.deforming, way / length);
                (length > FARTHEST * width).then_some((i, length, width))
            });
        let Some((block, way, width)) = leaps.min_by_key(|leap| leap.0) else {
            return Ok(());
        };
        let message = format!(
            "at {:.3e} m/s it moves {way:.3e} m in a step of {dt:.3e} s, more than half of the {width:.3e} m that it is \
             wide along its way, and could pass through others unseen; take a time_step of at most {:.3e} s, or look \
             at what makes it so fast",
            way / dt,
            dt * FARTHEST * width / way
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
    let mut reach = |from: f64, to: f64| (low, high) = (low.min(from), high.max(to));
    for part in body.shape.parts() {
        let centre = along.dot(part.offset);
        match &part.form {
            Form::Sphere { radius } => reach(centre - radius, centre + radius),
            Form::Convex(polyhedron) => {
                for vertex in polyhedron.vertices() {
                    let at = centre + along.dot(*vertex);
                    reach(at, at);
                }
            }
        }
    }
    high - low
}
