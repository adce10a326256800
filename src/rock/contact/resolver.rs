//! Resolution of a pair: bounding spheres, cache, proof of contact or separation, and the contact geometry.

use super::{
    Cache, Placed,
    centre::{Centring, barrier, overlap, potential},
    closed_form::{Proximity, proven, smallest_slack, sphere_polyhedron, sphere_sphere},
    pair::{Pair, Row},
    polygon::Polygons,
    program::{Optimum, Program},
    section::Overlap,
};
use crate::{Error, Result};
use glam::{DMat3, DVec3};
use std::ops::AddAssign;

/// Share of the smallest centroid-to-face distance beyond which an overlap is deep.
const DEEP: f64 = 0.1;

/// Resolves pairs one after the other; each thread needs its own. It holds solvers and scratch space, so that
/// nothing is allocated once all kinds of pairs have occurred. Its results do not depend on the pairs that
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
    /// A new resolver.
    pub fn new(options: Options) -> Self {
        Self {
            options,
            ..Self::default()
        }
    }

    /// Counters of the pairs resolved so far.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Determines whether `first` and `second` are in contact, and the contact geometry. `cache` belongs to the
    /// pair; its content affects the run time and, apart from rounding, nothing else. The same pair in the other
    /// order gives the opposite normal and otherwise the same bits: internally the pair is ordered by size,
    /// then by position.
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
        // Rounding of the square is far below this margin; closer pairs are resolved in full.
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
        // The more likely proof is tried first.
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

    /// The contact around `start`, a point inside both blocks (in L). Its normal points from the smaller to
    /// the larger block.
    fn describe(&mut self, pair: &Pair<'_>, split: usize, start: DVec3) -> ContactGeometry {
        let mut point = start;
        self.counts.newton_steps += self.centring.run(&self.rows, 0.0, &mut point);
        let (rows, slacks) = (&self.rows[..], &self.centring.slacks[..]);
        let mut normal = barrier(rows, slacks, split);
        if self.options.normal == Normal::Potential {
            let depth = overlap(rows, slacks, split, normal);
            let least = pair
                .small
                .smallest_distance
                .min(pair.large.smallest_distance);
            let rounding = (2.0 * depth).max(0.01 * least / pair.length);
            normal = potential(rows, slacks, split, rounding);
        }
        let level = self.options.normal == Normal::Barrier;
        let around = Overlap {
            rows,
            slacks,
            split,
            normal,
        };
        let section = around.section(&mut self.polygons, level);
        let length = pair.length;
        let place = |x: DVec3| pair.small.centre + x * length;
        ContactGeometry {
            point: place(point),
            normal: section.normal,
            overlap: section.overlap * length,
            area: section.area * length * length,
            pressure_centre: place(point + section.pressure_centre),
            width: section.width * length,
            spread: section.spread * (length * length),
            limit: 0.0,
        }
    }

    /// Finds a proof if the cache has none. `near`: the cached point, which is outside.
    fn prove(
        &mut self,
        pair: &Pair<'_>,
        split: usize,
        margin: f64,
        near: Option<DVec3>,
    ) -> Result<Proof> {
        if let Some(normal) = pair.separating_face(margin)
            && let Some(verdict) = pair.judge(normal, margin)
        {
            self.counts.guesses += 1;
            return Ok(Proof::Plane(normal, verdict));
        }
        let point = pair.point_between(&self.rows, split);
        if smallest_slack(&self.rows, point) > margin {
            self.counts.guesses += 1;
            return Ok(Proof::Point(point));
        }
        if let Some(near) = near {
            let proof = self.widen(pair, split, margin, near);
            let Proof::Neither = proof else {
                self.counts.guesses += 1;
                return Ok(proof);
            };
        }
        let rows = &self.rows[..];
        let test = |optimum: &Optimum<'_>| {
            if smallest_slack(rows, optimum.point) > margin {
                return Proof::Point(optimum.point);
            }
            let normal = optimum.normal(rows, split);
            match pair.judge(normal, margin) {
                Some(verdict) => Proof::Plane(normal.normalize(), verdict),
                None => Proof::Neither,
            }
        };
        self.counts.programs += 1;
        let optimum = self.program.solve(rows)?;
        let proof = test(&optimum);
        let Proof::Neither = proof else {
            return Ok(proof);
        };
        self.counts.programs += 1;
        let point = optimum.point;
        Ok(test(&self.program.magnify(rows, point)?))
    }

    /// Finds a proof from a point just outside (method of centres, Huard 1967): all faces are moved outwards until
    /// the point is inside. The analytic centre of the enclosed region is then deeper: it is inside the blocks
    /// themselves, or its normal separates them.
    fn widen(&mut self, pair: &Pair<'_>, split: usize, margin: f64, near: DVec3) -> Proof {
        let mut point = near;
        for _ in 0..WIDENINGS {
            let widening = 1.25 * (margin - smallest_slack(&self.rows, point));
            if !(margin..LARGEST_WIDENING).contains(&widening) {
                break;
            }
            let rows = &self.rows[..];
            self.counts.newton_steps += self.centring.run(rows, widening, &mut point);
            if smallest_slack(rows, point) > margin {
                return Proof::Point(point);
            }
            let normal = barrier(rows, &self.centring.slacks, split);
            if let Some(verdict) = pair.judge(normal, margin) {
                return Proof::Plane(normal, verdict);
            }
        }
        Proof::Neither
    }
}

/// Resolves a pair with a sphere, in closed form.
fn round(pair: &Pair<'_>, cache: &mut Cache) -> Verdict {
    let margin = pair.rounding();
    let plane = cache.normal(pair);
    if let Some(verdict) = pair.judge(plane, margin) {
        return verdict;
    }
    let (small, large) = (pair.small, pair.large);
    let found = match (small.faces.is_empty(), large.faces.is_empty()) {
        (true, true) => sphere_sphere(small, large),
        (false, _) => sphere_polyhedron(small, large),
        (true, false) => {
            let other = sphere_polyhedron(large, small);
            Proximity {
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

/// Checks that a block has a positive size and a finite position.
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

/// Options of a [`Resolver`](super::Resolver).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// Definition of the contact normal.
    pub normal: Normal,
}

/// Definition of the contact normal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Normal {
    /// Σ a/t over one block's faces at the analytic centre, t their slacks: equal and opposite for
    /// both blocks, without a parameter; the normal of the faces if they lie flat on each other.
    #[default]
    Barrier,
    /// Gradient of Boon's potential particle, Σ ⟨a·x − d + r⟩² − r², averaged over both blocks, with
    /// r = max(2 u_n, d_min/100): at r = d_min/2, as often used, face contacts tilt by up to 10°.
    Potential,
}

/// Numbers of pairs by the proof that decided them, and amounts of work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Pairs resolved.
    pub pairs: u64,
    /// Pairs separated by their bounding spheres.
    pub bounds: u64,
    /// Pairs decided by the cached plane.
    pub planes: u64,
    /// Pairs in contact by the cached point.
    pub points: u64,
    /// Pairs decided by a face, the line of centres, or the surroundings of the cached point.
    pub guesses: u64,
    /// Linear programs solved.
    pub programs: u64,
    /// Contacts found.
    pub contacts: u64,
    /// Pairs that touch within rounding.
    pub undecided: u64,
    /// Newton steps towards analytic centres.
    pub newton_steps: u64,
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.pairs += other.pairs;
        self.bounds += other.bounds;
        self.planes += other.planes;
        self.points += other.points;
        self.guesses += other.guesses;
        self.programs += other.programs;
        self.contacts += other.contacts;
        self.undecided += other.undecided;
        self.newton_steps += other.newton_steps;
    }
}

/// How often the faces of a pair whose cached point is outside are moved outwards, and the violation (in L)
/// from which this is not tried: each time costs 1 µs and moves the point inwards by a share, compared with
/// 50 µs for the linear program.
const WIDENINGS: usize = 4;
const LARGEST_WIDENING: f64 = 0.01;

/// Proof found for a pair.
enum Proof {
    /// A plane, its normal from the smaller to the larger block, and its verdict.
    Plane(DVec3, Verdict),
    /// A point inside both blocks, in L.
    Point(DVec3),
    Neither,
}

/// Geometry of a contact. Vectors are in world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactGeometry {
    /// A point deep inside the overlap, its analytic centre, m.
    pub point: DVec3,
    /// Unit normal from the first block to the second.
    pub normal: DVec3,
    /// Overlap u_n along the normal, m. For a face contact, its mean over the section, so that
    /// `area` × `overlap` is the volume of overlap.
    pub overlap: f64,
    /// Area of the section of the overlap, m².
    pub area: f64,
    /// Point of action of the resultant of a pressure that grows with the overlap, m.
    pub pressure_centre: DVec3,
    /// Largest extent of the section, m.
    pub width: f64,
    /// ∫ x xᵀ dA/A of the section about its centroid, m².
    pub spread: DMat3,
    /// Overlap beyond which the blocks no longer count as hard, a tenth of the smallest distance of a
    /// face from the centroid of its block, m.
    pub limit: f64,
}

impl ContactGeometry {
    /// Whether the overlap is beyond its limit: the stiffness is too low, or the step too long.
    /// The caller, which knows the names of the blocks, can return an [`Error::DeepOverlap`](crate::Error::DeepOverlap).
    pub fn is_deep(&self) -> bool {
        self.overlap > self.limit
    }

    /// The same contact with the blocks in the other order.
    pub(super) fn swapped(self) -> Self {
        Self {
            normal: -self.normal,
            ..self
        }
    }
}

/// Proven relation of two blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// A plane separates the blocks.
    Apart,
    /// Neither plane nor point is found: the gap or overlap is within rounding. No force acts, and
    /// the history of the contact is kept.
    Undecided,
    /// A point is inside both blocks.
    Contact(ContactGeometry),
}
