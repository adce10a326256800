//! The bodies of a setup from its blocks.

use super::{
    Body, ParticleLattice, Scheme,
    convex_part::ConvexPart,
    solid::{mark_covered_faces, solids},
};
use crate::rock::{Block, Motion};
use glam::DVec3;

/// The bodies of `blocks` with their `boundary` particles ([`boundary_particles`](super::boundary_particles)), none of
/// them with free slip. `is_probed` says whose loads are measured.
pub fn bodies(
    blocks: &[Block],
    boundary: Vec<Vec<DVec3>>,
    lattice: &ParticleLattice,
    scheme: Scheme,
    is_probed: impl Fn(&Block) -> bool,
) -> Vec<Body> {
    let boundary = transfer_interior(blocks, boundary, &is_probed);
    let mut solids = solids(blocks, lattice);
    if scheme == Scheme::Delta {
        mark_covered_faces(blocks, &mut solids, lattice);
    }
    let bodies = blocks.iter().zip(boundary).zip(solids);
    let bodies = bodies.map(|((block, boundary), solids)| Body {
        boundary,
        solids: solids
            .into_iter()
            .map(|solid| solid.in_body_frame(block))
            .collect(),
        moves: block.motion != Motion::Fixed,
        // The energy ledger needs the loads on all moving bodies.
        loaded: block.motion != Motion::Fixed || is_probed(block),
        accelerates: matches!(block.motion, Motion::Driven { .. }),
        free_slip: false,
    });
    bodies.collect()
}

/// Transfers the boundary particles that a fixed block with a load probe (`is_probed`) has inside adjacent walls to a
/// fixed block without one, so that the load on the probed block acts on its own surface only.
fn transfer_interior(
    blocks: &[Block],
    mut boundary: Vec<Vec<DVec3>>,
    is_probed: impl Fn(&Block) -> bool,
) -> Vec<Vec<DVec3>> {
    let is_fixed = |block: &Block| block.motion == Motion::Fixed;
    let takes = |block: &Block| is_fixed(block) && !is_probed(block);
    let Some(target) = blocks.iter().position(takes) else {
        return boundary;
    };
    for (n, block) in blocks.iter().enumerate() {
        if !is_fixed(block) || !is_probed(block) {
            continue;
        }
        let parts = ConvexPart::of_block(block);
        let world = |x: &DVec3| block.centre + block.rotation * *x;
        let is_own = |x: &DVec3| parts.iter().any(|part| part.depth(world(x)) > 0.0);
        let (kept, beyond): (Vec<_>, Vec<_>) = boundary[n].iter().copied().partition(is_own);
        boundary[n] = kept;
        let to = &blocks[target];
        let moved = beyond
            .iter()
            .map(|x| to.rotation.inverse() * (world(x) - to.centre));
        boundary[target].extend(moved);
    }
    boundary
}
