//! The forces of all contacts: in parallel over the pairs, in the order of the pairs.

use super::{
    Body,
    body::Flight,
    bonds::unbonded,
    deforming::{DeformingBlocks, RIGID},
    films::Film,
    parts::Parts,
    period::Periods,
    resolvers::Resolvers,
    touch::{NONE, Pair, TENTHS, Touch},
    touches::{CHUNK, Chunk, Touches},
};
use crate::{
    Error, Result,
    rock::{
        contact::{Contact, Placed, Resolver, Seam, Squeeze, Verdict},
        law::{self, History, Joint},
    },
};
use glam::DVec3;
use rayon::prelude::*;

/// Share of the square of a block's width that one of the four corners of its face carries: see
/// [`Setup::corner_area`](super::Setup::corner_area).
const CORNER: f64 = 0.25;

/// What the contacts are computed from.
pub(super) struct Scene<'a> {
    pub bodies: &'a [Body],
    pub flights: &'a [Flight],
    pub deforming: &'a DeformingBlocks,
    pub parts: &'a Parts,
    pub joints: &'a Joints,
    /// Contacts of the last step.
    pub touches: &'a Touches,
    /// s; 0 at the start.
    pub time_step: f64,
    /// Whether faces that touch now are bonded.
    pub bonding: bool,
    /// Largest overlap, as a share of the smaller distance from centroid to face.
    pub largest_overlap: f64,
    /// Least area of a contact's springs, as a share of the square of twice that distance.
    pub corner_area: f64,
    /// Fluid in thin gaps.
    pub film: Option<&'a law::Film>,
    pub periods: Option<&'a Periods>,
}

/// The joint of every two materials.
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

/// Resolves all `pairs` into `next`; their contacts into `found`, whatever the number of threads.
///
/// # Errors
/// That of the first pair that cannot be resolved.
pub(super) fn resolve(
    scene: &Scene<'_>,
    resolvers: &mut Resolvers,
    pairs: &[Pair],
    next: &mut Vec<Pair>,
    found: &mut Touches,
) -> Result<()> {
    resolvers.prepare(rayon::current_num_threads());
    let resolvers = &*resolvers;
    next.resize(pairs.len(), Pair::new([0; 2], [0; 3]));
    found.reset(pairs.len());
    let places = next.par_chunks_mut(CHUNK).zip(&mut found.chunks);
    let chunks = pairs.par_chunks(CHUNK).zip(places).enumerate();
    let failed = chunks.filter_map(|(n, (pairs, (next, found)))| {
        let done = resolvers.with(|resolver| scene.chunk(resolver, n, pairs, next, found));
        done.err().map(|error| (n, error))
    });
    match failed.min_by_key(|(n, _)| *n) {
        Some((_, error)) => Err(error),
        None => Ok(()),
    }
}

impl Scene<'_> {
    /// The chunk `n` of the pairs.
    fn chunk(
        &self,
        resolver: &mut Resolver,
        n: usize,
        pairs: &[Pair],
        next: &mut [Pair],
        found: &mut Chunk,
    ) -> Result<()> {
        found.touches.clear();
        found.ended.clear();
        found.films.clear();
        for (pair, next) in pairs.iter().zip(next) {
            *next = *pair;
            let before = self.touches.of(pair);
            let room = (&mut found.films, &mut found.image);
            let touch = self.pair(resolver, next, before, room)?;
            next.touch = match touch {
                Some(_) => (n * CHUNK + found.touches.len()) as u32,
                None => NONE,
            };
            if let (Some(before), None) = (before, touch) {
                // Its force acted for half a step yet.
                let held = before.stored + 0.5 * self.time_step * before.power;
                found.ended.push(held);
            }
            found.touches.extend(touch);
        }
        Ok(())
    }

    fn pair(
        &self,
        resolver: &mut Resolver,
        pair: &mut Pair,
        before: Option<&Touch>,
        (films, image): (&mut Vec<Film>, &mut Placed),
    ) -> Result<Option<Touch>> {
        let blocks = pair.parts.map(|part| self.parts.block[part as usize]);
        if blocks.iter().all(|&b| self.flights[b as usize].rests) {
            // Nothing slips where nothing moves.
            return Ok(before.map(|touch| Touch {
                force: law::Force {
                    friction: 0.0,
                    ..touch.force
                },
                ..*touch
            }));
        }
        let [first, second] = pair.parts.map(|part| &self.parts.placed[part as usize]);
        let way = self
            .periods
            .map_or(DVec3::ZERO, |periods| periods.period.way(pair.turns));
        let second = match pair.turns {
            [0, 0, 0] => second,
            _ => {
                image.copy_moved(second, way);
                image
            }
        };
        let bonded = before.filter(|touch| touch.seam.area > 0.0);
        if let Some(touch) = bonded {
            let place = (pair.parts, blocks, way);
            if let Some(held) = self.held(place, [first, second], &touch.seam, before) {
                return self.hard(held, blocks).map(Some);
            }
        }
        let joint = self.joint(blocks);
        if self.bonding
            && joint.tensile_strength > 0.0
            && let Some(seam) = Seam::between(first, second)
        {
            let place = (pair.parts, blocks, way);
            if let Some(held) = self.held(place, [first, second], &seam, None) {
                return Ok(Some(held));
            }
        }
        let verdict = resolver
            .resolve(first, second, &mut pair.cache)
            .map_err(|error| {
                let [a, b] = blocks.map(|block| self.name(block));
                Error::argument(format!("{a} and {b}"), error.to_string())
            })?;
        if let (Some(film), Verdict::Apart | Verdict::Touching) = (self.film, verdict)
            && blocks
                .iter()
                .all(|&b| self.bodies[b as usize].deforming == RIGID)
            && let Some(squeeze) = Squeeze::between(first, second, film.reach())
        {
            let [a, b] = blocks.map(|block| self.flights[block as usize].centre);
            let centres = [a, b + way];
            films.extend(Film::of(&squeeze, film, blocks, centres));
        }
        Ok(match verdict {
            Verdict::Apart => None,
            Verdict::Touching => before.map(|touch| Touch {
                seam: Seam::default(),
                overlap: 0.0,
                area: 0.0,
                section: 0.0,
                force: law::Force {
                    history: unbonded(touch),
                    ..law::Force::default()
                },
                ..*touch
            }),
            Verdict::Contact(contact) => {
                let touch = self.touch((pair.parts, blocks, way), &contact, before);
                Some(self.hard(touch, blocks)?)
            }
        })
    }

    /// Refuses what is pressed in too deep.
    fn hard(&self, touch: Touch, blocks: [u32; 2]) -> Result<Touch> {
        let limit = TENTHS * self.largest_overlap * touch.limit;
        if touch.overlap <= limit {
            return Ok(touch);
        }
        let usual = "take a greater normal_stiffness, press them together more slowly, or allow a \
                     greater largest_overlap";
        let corner = CORNER * (2.0 * TENTHS * touch.limit).powi(2);
        Err(Error::DeepOverlap {
            first: self.name(blocks[0]),
            second: self.name(blocks[1]),
            depth: touch.overlap,
            limit,
            remedy: match touch.area < corner {
                true => format!(
                    "they touch with a corner or an edge, over {:.1e} m², which is soft: set \
                     rock.corner_area = {CORNER}, which counts it as {corner:.1e} m²; or {usual}",
                    touch.area
                ),
                false => usual.into(),
            },
        })
    }

    pub(super) fn joint(&self, blocks: [u32; 2]) -> &Joint {
        let [a, b] = blocks.map(|block| self.flights[block as usize].material);
        self.joints.of(a, b)
    }

    /// How two blocks move about `at` (m), beside the first.
    pub(super) fn motion(&self, blocks: [u32; 2], at: DVec3, way: DVec3) -> law::Motion {
        let [a, b] = blocks.map(|block| &self.flights[block as usize]);
        let [ra, rb] = [at - a.centre, at - way - b.centre];
        let mut mean = b.velocity + b.spin.cross(rb) - a.velocity - a.spin.cross(ra);
        let mut end = b.end_velocity + b.end_spin.cross(rb) - a.end_velocity - a.end_spin.cross(ra);
        if !self.deforming.is_empty() {
            let [more, end_more] = self.stretch(blocks, [ra, rb]);
            (mean, end) = (mean + more, end + end_more);
        }
        law::Motion {
            way: mean * self.time_step,
            velocity: end,
            spin: b.spin - a.spin,
            frame: a.rotation,
            time_step: self.time_step,
            mass: 1.0 / (a.inverse_mass + b.inverse_mass),
        }
    }

    fn touch(
        &self,
        (parts, blocks, way): ([u32; 2], [u32; 2], DVec3),
        contact: &Contact,
        before: Option<&Touch>,
    ) -> Touch {
        let joint = self.joint(blocks);
        let at = contact.pressure_centre;
        let motion = self.motion(blocks, at, way);
        let square = (2.0 * TENTHS * contact.limit).powi(2);
        let section = law::Section {
            normal: contact.normal,
            overlap: contact.overlap,
            area: contact.area,
            elastic_area: contact.area.max(self.corner_area * square),
            rolls: parts
                .iter()
                .any(|&part| self.parts.placed[part as usize].is_sphere()),
            gape: 0.0,
        };
        // What was bonded is so no more.
        let history = before.map_or_else(History::default, unbonded);
        Touch {
            parts,
            blocks,
            way,
            point: contact.point,
            pressure_centre: at,
            normal: contact.normal,
            overlap: contact.overlap,
            area: section.elastic_area,
            section: section.area,
            width: contact.width,
            limit: contact.limit,
            force: law::force(joint, &section, &motion, &history),
            seam: Seam::default(),
            stored: before.map_or(0.0, |touch| touch.stored),
            power: before.map_or(0.0, |touch| touch.power),
        }
    }

    /// What deformation adds to the velocity of the second of two blocks against the first, over the step and
    /// at its end, m/s: the symmetric part of ∂v/∂x, whose skew part is the spin.
    fn stretch(&self, blocks: [u32; 2], arms: [DVec3; 2]) -> [DVec3; 2] {
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
}

/// A block in a message.
pub(super) fn label(index: usize, name: &str) -> String {
    format!("blocks[{index}] ({name})")
}
