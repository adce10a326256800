//! Resolution of a pair: bounding spheres, cache, proof, description.

use super::{
    Cache, ContactGeometry, Counts, Options, Placed, Verdict,
    centre::Centring,
    closed_form_proofs::smallest_slack,
    pair::{Pair, Row},
    polygon::Polygons,
    program::Program,
    prove::Proof,
    separation::proven,
    sphere,
};
use crate::{Error, Result};

/// Share of the smallest distance of a face from its centroid beyond which an overlap is deep.
const DEEP: f64 = 0.1;

/// Resolves pairs one after the other: one a thread. It holds solvers and scratch space, so that
/// nothing is allocated once all kinds of pairs have been seen; its answers depend on nothing that
/// it resolved before.
#[derive(Default)]
pub struct Resolver {
    pub(super) options: Options,
    pub(super) counts: Counts,
    pub(super) rows: Vec<Row>,
    pub(super) program: Program,
    pub(super) centring: Centring,
    pub(super) polygons: Polygons,
}

impl Resolver {
    /// A resolver without history.
    pub fn new(options: Options) -> Self {
        Self {
            options,
            ..Self::default()
        }
    }

    /// How the pairs so far were decided.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Whether `first` and `second` are in contact, and how. `cache` is the pair's own; what it
    /// holds changes the time and, within rounding, nothing else. The same pair in the other order
    /// gives the opposite normal and otherwise the same bits: inside, the pair is ordered by size,
    /// then by place.
    ///
    /// # Errors
    /// If a pose is not finite.
    pub fn resolve(
        &mut self,
        first: &Placed,
        second: &Placed,
        cache: &mut Cache,
    ) -> Result<Verdict> {
        self.counts.pairs += 1;
        let square = first.centre.distance_squared(second.centre);
        check(first, square)?;
        check(second, square)?;
        let reach = first.radius + second.radius;
        // Rounding of the square is far below this margin; closer pairs are looked at properly.
        if square > reach * reach * (1.0 + 1e-12) {
            self.counts.bounds += 1;
            cache.contact = false;
            return Ok(Verdict::Apart);
        }
        let pair = Pair::new(first, second);
        let verdict = if first.faces.is_empty() || second.faces.is_empty() {
            round(&pair, cache)
        } else {
            self.polyhedra(&pair, cache)?
        };
        Ok(match verdict {
            Verdict::Contact(contact) => {
                self.counts.contacts += 1;
                let contact = ContactGeometry {
                    limit: DEEP * first.smallest_distance.min(second.smallest_distance),
                    ..contact
                };
                Verdict::Contact(if pair.flipped {
                    contact.swapped()
                } else {
                    contact
                })
            }
            Verdict::Undecided => {
                self.counts.undecided += 1;
                verdict
            }
            Verdict::Apart => {
                cache.contact = false;
                verdict
            }
        })
    }

    fn polyhedra(&mut self, pair: &Pair<'_>, cache: &mut Cache) -> Result<Verdict> {
        let margin = pair.rounding();
        let plane = cache.normal(pair);
        // The likelier proof first.
        if !cache.contact
            && let Some(verdict) = pair.judge(plane, margin)
        {
            self.counts.planes += 1;
            return Ok(verdict);
        }
        let split = pair.fill(&mut self.rows);
        let kept = cache.place(pair);
        let point = kept.map(|point| point / pair.length);
        let inside = point.filter(|point| smallest_slack(&self.rows, *point) > margin);
        let proof = if let Some(point) = inside {
            self.counts.points += 1;
            Proof::Point(point)
        } else if cache.contact
            && let Some(verdict) = pair.judge(plane, margin)
        {
            self.counts.planes += 1;
            return Ok(verdict);
        } else {
            self.prove(pair, split, margin, point)?
        };
        Ok(match proof {
            Proof::Neither => Verdict::Undecided,
            Proof::Plane(normal, verdict) => {
                cache.hold(pair, normal, kept);
                verdict
            }
            Proof::Point(point) => {
                let contact = self.describe(pair, split, point);
                let place = contact.point - pair.small.centre;
                cache.hold(pair, contact.normal, Some(place));
                cache.contact = true;
                Verdict::Contact(contact)
            }
        })
    }
}

/// A pair with a sphere, in closed form.
fn round(pair: &Pair<'_>, cache: &mut Cache) -> Verdict {
    let margin = pair.rounding();
    let plane = cache.normal(pair);
    if let Some(verdict) = pair.judge(plane, margin) {
        return verdict;
    }
    let (small, large) = (pair.small, pair.large);
    let found = match (small.faces.is_empty(), large.faces.is_empty()) {
        (true, true) => sphere::spheres(small, large),
        (false, _) => sphere::polyhedron(small, large),
        (true, false) => {
            let other = sphere::polyhedron(large, small);
            sphere::Proximity {
                contact: other.contact.swapped(),
                ..other
            }
        }
    };
    let place = found.contact.point - small.centre;
    cache.hold(pair, found.contact.normal, Some(place));
    proven(found.gap, margin * pair.length).unwrap_or_else(|| {
        cache.contact = true;
        Verdict::Contact(found.contact)
    })
}

/// That a block has a size and a place.
fn check(block: &Placed, square: f64) -> Result<()> {
    let sizes = block.radius * block.smallest_distance;
    if square.is_finite() && sizes.is_finite() && sizes > 0.0 {
        return Ok(());
    }
    Err(Error::argument(
        "contact",
        format!(
            "a block of radius {} m at {} m is not finite; shorten the time step, or look for the force that threw it",
            block.radius, block.centre
        ),
    ))
}
