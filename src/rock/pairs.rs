//! The list of candidate pairs, and how long it lives.

use super::{
    Body,
    body::State,
    deforming::DeformingBlocks,
    period::Image,
    step::FEW,
    touch::{NONE, Pair},
};
use crate::{Error, Result};
use glam::{DQuat, DVec3};
use rayon::prelude::*;

/// Where a block was when the list was made, and how far it may go from there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mark {
    pub centre: DVec3,
    pub rotation: DQuat,
    /// By how much its boxes were grown, m.
    pub room: f64,
}

impl Mark {
    /// No point of the block has moved farther than this, m.
    fn moved(&self, body: &Body, state: &State, deforming: &DeformingBlocks) -> f64 {
        let way = (state.centre - self.centre).length();
        if let Some(strayed) = deforming.strayed(body) {
            return way + strayed;
        }
        let turn = state.rotation * self.rotation.conjugate();
        // A point at the distance r from the axis moves by 2 r sin(θ/2).
        way + 2.0 * turn.xyz().length() * body.radius
    }
}

/// By how much the boxes of a block are grown: half the skin, or two steps' way of a fast one, m.
pub(super) fn room(
    body: &Body,
    state: &State,
    deforming: &DeformingBlocks,
    skin: f64,
    dt: f64,
) -> f64 {
    (0.5 * skin).max(2.0 * ahead(body, state, deforming, dt))
}

/// Way of the fastest point in a step, m.
fn ahead(body: &Body, state: &State, deforming: &DeformingBlocks, dt: f64) -> f64 {
    if body.is_fixed() || state.asleep {
        return 0.0;
    }
    deforming.fastest(body, state) * dt
}

/// Whether some block may leave its boxes within a step, so that pairs may be missing.
pub(super) fn outlived(
    bodies: &[Body],
    states: &[State],
    deforming: &DeformingBlocks,
    marks: &[Mark],
    dt: f64,
) -> bool {
    let all = bodies.par_iter().zip(states).zip(marks).with_min_len(FEW);
    all.filter(|((body, state), _)| !body.is_fixed() && !state.asleep)
        .any(|((body, state), mark)| {
            let ahead = ahead(body, state, deforming, dt);
            mark.moved(body, state, deforming) + ahead > mark.room
        })
}

/// A new list that keeps what the pairs of the old one remember. A contact whose pair is not in `new` is
/// kept all the same: its history ends only where the resolver says so.
///
/// `lasting`: what of the periods between the parts of a pair tells it from another pair of theirs.
pub(super) fn merged(
    old: &[Pair],
    new: &[Near],
    lasting: impl Fn([u32; 2], [i32; 3]) -> [i32; 3],
) -> Vec<Pair> {
    let mut list = Vec::with_capacity(new.len());
    let mut rest = old.iter().copied().peekable();
    let key = |parts: [u32; 2], turns: [i32; 3]| (parts, lasting(parts, turns));
    for &(parts, turns) in new {
        let wanted = key(parts, turns);
        while let Some(pair) = rest.next_if(|pair| key(pair.parts, pair.turns) < wanted) {
            list.extend((pair.touch != NONE).then_some(pair));
        }
        let kept = rest.next_if(|pair| key(pair.parts, pair.turns) == wanted);
        list.push(kept.map_or_else(|| Pair::new(parts, turns), |pair| Pair { turns, ..pair }));
    }
    list.extend(rest.filter(|pair| pair.touch != NONE));
    list
}

/// Two parts that may touch, and the periods by which the second is then moved.
pub(super) type Near = ([u32; 2], [i32; 3]);

/// From pairs of items to pairs of parts, without what is never computed: pairs of one block, and of two that forces
/// do not move. `images`: which parts the items are; without them each is its own.
///
/// # Errors
/// If the list is not sorted, names an item that does not exist, or names a pair twice.
pub(super) fn checked(
    pairs: Vec<[u32; 2]>,
    images: Option<&[Image]>,
    block: &[u32],
    bodies: &[Body],
) -> Result<Vec<Near>> {
    let items = images.map_or(block.len(), <[Image]>::len);
    let known = |pair: &[u32; 2]| pair[0] < pair[1] && (pair[1] as usize) < items;
    if let Some(pair) = pairs.iter().find(|pair| !known(pair)) {
        return Err(Error::argument(
            "pairs",
            format!("{pair:?} must be two of the {items} items in ascending order"),
        ));
    }
    if !pairs.is_sorted_by(|a, b| a < b) {
        let message = "the finder must return the pairs sorted, each once";
        return Err(Error::argument("pairs", message));
    }
    let matters = |(parts, _): &Near| {
        let [a, b] = parts.map(|part| block[part as usize]);
        a != b && (bodies[a as usize].is_free() || bodies[b as usize].is_free())
    };
    let Some(images) = images else {
        let own = pairs.into_iter().map(|parts| (parts, [0; 3]));
        return Ok(own.filter(matters).collect());
    };
    let near = |pair: [u32; 2]| {
        let mut ends = pair.map(|item| images[item as usize]);
        ends.sort_unstable_by_key(|image| image.part);
        let [a, b] = ends;
        let turns = std::array::from_fn(|axis| a.turns[axis] - b.turns[axis]);
        ([a.part, b.part], turns)
    };
    let mut list: Vec<Near> = pairs.into_iter().map(near).filter(matters).collect();
    // Two parts and two of their images are the same pair.
    list.sort_unstable();
    list.dedup();
    Ok(list)
}
