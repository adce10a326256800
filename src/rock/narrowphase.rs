//! Contacts and bonds of all candidate pairs and their forces, in parallel, with results in the order of the pairs.

use super::{
    Body,
    body::MidStep,
    candidate_pairs::{CandidatePair, PlacedParts},
    contact_list::{CHUNK, Chunk, Contact, ContactList, DISTANCES_PER_LIMIT, NO_CONTACT},
    damping::{Bodies, DampingShares},
    deforming::{DeformingBlocks, RIGID},
    films::Film,
    period::Periods,
    resolver_pool::ResolverPool,
    seams::{Role, Seams},
    threads,
};
use crate::{
    Error, Result,
    rock::{
        contact::{Bond, ContactGeometry, Placed, Resolver, ThinGap, Verdict},
        law::{self, History, Joint},
    },
};
use glam::DVec3;
use rayon::{iter::IntoParallelRefMutIterator, slice::ParallelSliceMut};
use rayon_cond::CondIterator;
use std::sync::Arc;

/// Area that one of the four corners of a face carries, relative to the square of the block's width: see
/// [`Setup::corner_area`](super::Setup::corner_area).
const CORNER_SHARE: f64 = 0.25;

/// Parts and blocks of a pair, and the periodic image of the second part.
#[derive(Clone, Copy, Debug)]
struct PairIds {
    pub parts: [u32; 2],
    pub blocks: [u32; 2],
    /// Shift of the second part to its image, m.
    pub image_shift: DVec3,
}

/// Input of the computation of contacts.
pub(super) struct Narrowphase<'a> {
    pub bodies: &'a [Body],
    pub mid_steps: &'a [MidStep],
    pub deforming: &'a DeformingBlocks,
    pub parts: &'a PlacedParts,
    pub joints: &'a Joints,
    /// Contacts of the last step.
    pub contacts: &'a ContactList,
    /// s; 0 at the start.
    pub time_step: f64,
    /// Whether faces that touch in this step are bonded.
    pub bonding: bool,
    /// Largest overlap, as a share of the smaller distance from centroid to face.
    pub largest_overlap: f64,
    /// Smallest area of a contact's springs, as a share of the square of twice that distance.
    pub corner_area: f64,
    /// Fluid in thin gaps.
    pub film: Option<&'a law::Film>,
    pub periods: Option<&'a Periods>,
}

/// The joint of each pair of materials.
#[derive(Clone, Debug)]
pub(super) struct Joints {
    pub materials: u32,
    pub table: Vec<Joint>,
}

impl Joints {
    pub fn of(&self, a: u32, b: u32) -> &Joint {
        &self.table[(a * self.materials + b) as usize]
    }
}

/// Resolves all `pairs`; writes the updated pairs to `next` and their contacts to `found`. The result does not depend on
/// the number of threads.
///
/// # Errors
/// The error of the first pair that cannot be resolved.
pub(super) fn resolve(
    narrowphase: &Narrowphase<'_>,
    resolver_pool: &mut ResolverPool,
    pairs: &[CandidatePair],
    next: &mut Vec<CandidatePair>,
    found: &mut ContactList,
) -> Result<()> {
    resolver_pool.prepare(rayon::current_num_threads());
    let resolver_pool = &*resolver_pool;
    next.resize(pairs.len(), CandidatePair::new([0; 2], [0; 3]));
    found.reset(pairs.len());
    let seams = Seams::of(narrowphase, pairs);
    let bonded = narrowphase
        .contacts
        .iter()
        .any(|contact| contact.bond.is_some());
    let before = match bonded {
        true => DampingShares::of(narrowphase.contacts, narrowphase.bodies_of_contacts()),
        false => DampingShares::default(),
    };
    let parallel = pairs.len() >= threads::PAIRS;
    let chunks = match parallel {
        true => CondIterator::Parallel(next.par_chunks_mut(CHUNK)),
        false => CondIterator::Serial(next.chunks_mut(CHUNK)),
    };
    let chunks = chunks.zip(&mut found.chunks).enumerate();
    let last = LastStep {
        seams,
        shares: before,
    };
    let failed = chunks.filter_map(|(n, (next, found))| {
        let first = n * CHUNK;
        let pairs = &pairs[first..first + next.len()];
        let done = resolver_pool
            .with(|resolver| narrowphase.chunk(resolver, n, pairs, &last, next, found));
        done.err().map(|error| (n, error))
    });
    if let Some((_, error)) = failed.min_by_key(|(n, _)| *n) {
        return Err(error);
    }
    let shares = DampingShares::of(found, narrowphase.bodies_of_contacts());
    let chunks = match parallel {
        true => CondIterator::Parallel(found.chunks.par_iter_mut()),
        false => CondIterator::Serial(found.chunks.iter_mut()),
    };
    chunks.for_each(|chunk| narrowphase.act(chunk, &shares));
    Ok(())
}

/// What the contacts of the last step determine in this one.
struct LastStep {
    seams: Seams,
    /// Of bonds, whose areas last.
    shares: DampingShares,
}

impl Narrowphase<'_> {
    /// Resolves the chunk `n` of the pairs.
    fn chunk(
        &self,
        resolver: &mut Resolver,
        n: usize,
        pairs: &[CandidatePair],
        last: &LastStep,
        next: &mut [CandidatePair],
        found: &mut Chunk,
    ) -> Result<()> {
        found.contacts.clear();
        found.ended.clear();
        found.films.clear();
        found.geometries.clear();
        for (k, (pair, next)) in pairs.iter().zip(next).enumerate() {
            *next = *pair;
            let own = self.contacts.of(pair);
            let (before, contact) = match last.seams.role(n * CHUNK + k) {
                Some(Role::Hidden { passed_on }) => (own.filter(|_| !passed_on), None),
                role => {
                    let before = match role {
                        Some(Role::Successor(contact)) => Some(&**contact),
                        _ => own,
                    };
                    (
                        before,
                        self.pair(resolver, next, before, &last.shares, found)?,
                    )
                }
            };
            next.contact = match contact {
                Some(_) => (n * CHUNK + found.contacts.len()) as u32,
                None => NO_CONTACT,
            };
            if let (Some(before), None) = (before, &contact) {
                // The force of the ended contact has acted during the first half of the step.
                let stored = before.stored + 0.5 * self.time_step * before.power;
                found.ended.push(stored);
            }
            found.contacts.extend(contact);
        }
        Ok(())
    }

    fn pair(
        &self,
        resolver: &mut Resolver,
        pair: &mut CandidatePair,
        before: Option<&Contact>,
        shares: &DampingShares,
        found: &mut Chunk,
    ) -> Result<Option<Contact>> {
        let blocks = pair.parts.map(|part| self.parts.block[part as usize]);
        if blocks.iter().all(|&b| self.mid_steps[b as usize].rests) {
            // Blocks at rest do not slip.
            return Ok(before.map(|contact| Contact {
                force: law::Force {
                    friction: 0.0,
                    ..contact.force
                },
                ..contact.clone()
            }));
        }
        let [first, second] = pair.parts.map(|part| &self.parts.placed[part as usize]);
        let image_shift = self.image_shift(pair);
        let second = match pair.offset {
            [0, 0, 0] => second,
            _ => {
                found.image.copy_moved(second, image_shift);
                &found.image
            }
        };
        let ids = PairIds {
            parts: pair.parts,
            blocks,
            image_shift,
        };
        if let Some(bond) = before.and_then(|contact| contact.bond.as_ref())
            && let Some(bonded) = self.bonded_contact(ids, [first, second], bond, before, shares)
        {
            return self.check_depth(bonded, blocks).map(Some);
        }
        let joint = self.joint(blocks);
        if self.bonding
            && joint.tensile_strength > 0.0
            && let Some(bond) = Bond::between(first, second)
            && let Some(bonded) =
                self.bonded_contact(ids, [first, second], &Arc::new(bond), None, shares)
        {
            return Ok(Some(bonded));
        }
        let verdict = resolver
            .resolve(first, second, &mut pair.cache)
            .map_err(|error| {
                let [a, b] = blocks.map(|block| self.name(block));
                Error::argument(format!("{a} and {b}"), error.to_string())
            })?;
        if let (Some(film), Verdict::Apart | Verdict::Undecided) = (self.film, verdict)
            && blocks
                .iter()
                .all(|&b| self.bodies[b as usize].deforming == RIGID)
            && let Some(thin_gap) = ThinGap::between(first, second, film.reach())
        {
            let [a, b] = blocks.map(|block| self.mid_steps[block as usize].centre);
            let centres = [a, b + image_shift];
            found
                .films
                .extend(Film::of(&thin_gap, film, blocks, centres));
        }
        Ok(match verdict {
            Verdict::Apart => None,
            Verdict::Undecided => before.map(|contact| Contact {
                bond: None,
                overlap: 0.0,
                area: 0.0,
                section: 0.0,
                force: law::Force {
                    history: unbonded(contact),
                    ..law::Force::default()
                },
                ..*contact
            }),
            Verdict::Contact(geometry) => {
                let contact = self.contact(ids, &geometry, before);
                let contact = self.check_depth(contact, blocks)?;
                found.geometries.push((found.contacts.len(), geometry));
                Some(contact)
            }
        })
    }

    /// Shift of the second part of a pair to its image, m.
    pub(super) fn image_shift(&self, pair: &CandidatePair) -> DVec3 {
        let periods = self.periods;
        periods.map_or(DVec3::ZERO, |periods| periods.period.shift(pair.offset))
    }

    /// Returns an error if the penetration of a contact is too deep.
    fn check_depth(&self, contact: Contact, blocks: [u32; 2]) -> Result<Contact> {
        let limit = DISTANCES_PER_LIMIT * self.largest_overlap * contact.limit;
        if contact.overlap <= limit {
            return Ok(contact);
        }
        let usual = "take a greater normal_stiffness, press them together more slowly, or allow a \
                     greater largest_overlap";
        let corner = CORNER_SHARE * (2.0 * DISTANCES_PER_LIMIT * contact.limit).powi(2);
        Err(Error::DeepOverlap {
            first: self.name(blocks[0]),
            second: self.name(blocks[1]),
            depth: contact.overlap,
            limit,
            remedy: match contact.area < corner {
                true => format!(
                    "they touch with a corner or an edge, over {:.1e} m², which is soft: set \
                     rock.corner_area = {CORNER_SHARE}, which counts it as {corner:.1e} m²; or {usual}",
                    contact.area
                ),
                false => usual.into(),
            },
        })
    }

    pub(super) fn joint(&self, blocks: [u32; 2]) -> &Joint {
        let [a, b] = blocks.map(|block| self.mid_steps[block as usize].material);
        self.joints.of(a, b)
    }

    /// Relative motion of two blocks at the point `at` (m) of the first. The second block is shifted to its image by
    /// `image_shift` (m).
    pub(super) fn motion(&self, blocks: [u32; 2], at: DVec3, image_shift: DVec3) -> law::Motion {
        let [a, b] = blocks.map(|block| &self.mid_steps[block as usize]);
        let [ra, rb] = [at - a.centre, at - image_shift - b.centre];
        let mut mean = b.velocity + b.spin.cross(rb) - a.velocity - a.spin.cross(ra);
        let mut end = b.end_velocity + b.end_spin.cross(rb) - a.end_velocity - a.end_spin.cross(ra);
        if !self.deforming.is_empty() {
            let [more, end_more] = self.strain_velocity(blocks, [ra, rb]);
            (mean, end) = (mean + more, end + end_more);
        }
        law::Motion {
            displacement: mean * self.time_step,
            velocity: end,
            spin: b.spin - a.spin,
            frame: a.rotation,
            time_step: self.time_step,
            mass: 1.0 / (a.inverse_mass + b.inverse_mass),
        }
    }

    /// A contact with its history, without its force.
    fn contact(
        &self,
        ids: PairIds,
        geometry: &ContactGeometry,
        before: Option<&Contact>,
    ) -> Contact {
        let PairIds {
            parts,
            blocks,
            image_shift,
        } = ids;
        let square = (2.0 * DISTANCES_PER_LIMIT * geometry.limit).powi(2);
        Contact {
            parts,
            blocks,
            image_shift,
            point: geometry.point,
            pressure_centre: geometry.pressure_centre,
            normal: geometry.normal,
            overlap: geometry.overlap,
            area: geometry.area.max(self.corner_area * square),
            section: geometry.area,
            width: geometry.width,
            limit: geometry.limit,
            force: law::Force {
                // A broken bond stays broken.
                history: before.map_or_else(History::default, unbonded),
                ..law::Force::default()
            },
            bond: None,
            stored: before.map_or(0.0, |contact| contact.stored),
            power: before.map_or(0.0, |contact| contact.power),
        }
    }

    /// Adds the forces of the contacts in a chunk without a bond.
    fn act(&self, chunk: &mut Chunk, shares: &DampingShares) {
        for (index, geometry) in &chunk.geometries {
            let contact = &mut chunk.contacts[*index];
            let mut parts = contact.parts.iter();
            let section = law::Section {
                normal: contact.normal,
                overlap: contact.overlap,
                area: contact.section,
                elastic_area: contact.area,
                spread: geometry.spread,
                rolls: parts.any(|&part| self.parts.placed[part as usize].is_sphere()),
                opening: 0.0,
            };
            let joint = self.joint(contact.blocks);
            let motion = self.motion(contact.blocks, contact.pressure_centre, contact.image_shift);
            let motion = motion.damped_by(shares.share(contact, self.bodies_of_contacts()));
            contact.force = law::force(joint, &section, &motion, &contact.force.history);
        }
    }

    fn bodies_of_contacts(&self) -> Bodies<'_> {
        Bodies {
            bodies: self.bodies,
            parts: self.parts,
            mid_steps: self.mid_steps,
            joints: self.joints,
            repeated: self.periods.is_some(),
        }
    }

    /// Contribution of deformation to the velocity of the second block relative to the first, over the step and
    /// at its end, m/s: that of the symmetric part of ∂v/∂x; the skew part is the spin.
    fn strain_velocity(&self, blocks: [u32; 2], arms: [DVec3; 2]) -> [DVec3; 2] {
        let mut sums = [DVec3::ZERO; 2];
        for ((block, arm), sign) in blocks.into_iter().zip(arms).zip([-1.0, 1.0]) {
            let body = &self.bodies[block as usize];
            for (sum, gradient) in sums
                .iter_mut()
                .zip(self.deforming.gradients(body).iter().flat_map(|g| g.iter()))
            {
                let symmetric = (*gradient + gradient.transpose()) * 0.5;
                *sum += symmetric * arm * sign;
            }
        }
        sums
    }

    fn name(&self, block: u32) -> String {
        label(block as usize, &self.bodies[block as usize].name)
    }

    /// The contact of a bond at the present poses of its parts; `None` if it breaks.
    fn bonded_contact(
        &self,
        ids: PairIds,
        [first, second]: [&Placed; 2],
        bond: &Arc<Bond>,
        before: Option<&Contact>,
        shares: &DampingShares,
    ) -> Option<Contact> {
        let PairIds {
            parts,
            blocks,
            image_shift,
        } = ids;
        let now = bond.state(first, second);
        let joint = self.joint(blocks);
        let section = law::Section {
            normal: now.normal,
            overlap: now.overlap,
            area: bond.area,
            elastic_area: bond.area,
            spread: now.spread(bond),
            rolls: false,
            opening: now.overlap - now.smallest_overlap(bond),
        };
        let fresh = History {
            bonded: true,
            ..History::default()
        };
        let history = before.map_or(fresh, |contact| contact.force.history);
        let motion = self.motion(blocks, now.point, image_shift);
        let share = |before| shares.share(before, self.bodies_of_contacts());
        let motion = motion.damped_by(before.map_or(1.0, share));
        let force = law::force(joint, &section, &motion, &history);
        force.history.bonded.then(|| Contact {
            parts,
            blocks,
            image_shift,
            point: now.point,
            pressure_centre: now.point,
            normal: now.normal,
            overlap: now.overlap,
            area: bond.area,
            section: bond.area,
            width: bond.width,
            limit: 0.1 * first.smallest_distance.min(second.smallest_distance),
            force: law::Force {
                bending: joint.normal_stiffness * now.moment(bond),
                ..force
            },
            bond: Some(bond.clone()),
            stored: before.map_or(0.0, |contact| contact.stored),
            power: before.map_or(0.0, |contact| contact.power),
        })
    }
}

/// The name of a block for a message.
pub(super) fn label(index: usize, name: &str) -> String {
    format!("blocks[{index}] ({name})")
}

/// History of a contact without a bond.
fn unbonded(contact: &Contact) -> History {
    History {
        bonded: false,
        slip: 0.0,
        ..contact.force.history
    }
}
