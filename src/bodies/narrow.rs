//! The forces of all contacts: in parallel over the pairs, in the order of the pairs.

use super::{
    Body,
    body::{Flight, State},
    parts::Parts,
    touch::{NONE, Pair, TENTHS, Touch},
};
use crate::{
    Error, Result,
    contact::{Contact, Counts, Options, Resolver, Verdict},
    law::{self, History, Joint},
};
use rayon::prelude::*;
use std::{
    fmt,
    sync::{Mutex, PoisonError},
};

/// Pairs that one thread takes at a time: enough to outweigh the handing out.
const CHUNK: usize = 64;

/// One resolver a thread.
pub(super) struct Resolvers {
    options: Options,
    one_a_thread: Vec<Mutex<Resolver>>,
}

impl fmt::Debug for Resolvers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Resolvers")
            .field("options", &self.options)
            .field("threads", &self.one_a_thread.len())
            .finish()
    }
}

impl Resolvers {
    pub fn new(options: Options) -> Self {
        Self {
            options,
            one_a_thread: Vec::new(),
        }
    }

    /// What all of them have done.
    pub fn counts(&self) -> Counts {
        let mut sum = Counts::default();
        for resolver in &self.one_a_thread {
            let resolver = resolver.lock().unwrap_or_else(PoisonError::into_inner);
            sum += resolver.counts();
        }
        sum
    }

    fn prepare(&mut self, threads: usize) {
        let options = self.options;
        let new = || Mutex::new(Resolver::new(options));
        while self.one_a_thread.len() < threads {
            self.one_a_thread.push(new());
        }
    }

    fn with<T>(&self, work: impl FnOnce(&mut Resolver) -> T) -> T {
        let thread = rayon::current_thread_index().unwrap_or(0);
        let resolver = &self.one_a_thread[thread % self.one_a_thread.len()];
        // A resolver holds nothing from one pair to the next: one that a panic left is as good.
        work(&mut resolver.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// What the contacts are computed from.
pub(super) struct Scene<'a> {
    pub bodies: &'a [Body],
    pub states: &'a [State],
    pub flights: &'a [Flight],
    pub parts: &'a Parts,
    pub joints: &'a Joints,
    /// Contacts of the last step.
    pub touches: &'a [Touch],
    /// s; 0 at the start.
    pub time_step: f64,
    /// Whether contacts that begin now are bonded.
    pub bonding: bool,
    /// Largest overlap, as a share of the smaller distance from centroid to face.
    pub largest_overlap: f64,
}

/// The joint of every two materials.
#[derive(Clone, Debug)]
pub(super) struct Joints {
    pub materials: usize,
    pub table: Vec<Joint>,
}

impl Joints {
    pub fn of(&self, a: usize, b: usize) -> &Joint {
        &self.table[a * self.materials + b]
    }
}

/// Resolves all `pairs`; their contacts in the order of the pairs, whatever the number of threads.
///
/// # Errors
/// That of the first pair that cannot be resolved.
pub(super) fn resolve(
    scene: &Scene<'_>,
    resolvers: &mut Resolvers,
    pairs: &mut [Pair],
) -> Result<Vec<Touch>> {
    let threads = rayon::current_num_threads();
    resolvers.prepare(threads);
    let resolvers = &*resolvers;
    let run = |chunk: &mut [Pair]| {
        resolvers.with(|resolver| {
            let mut found = Vec::new();
            for pair in chunk {
                let touch = scene.pair(resolver, pair)?;
                pair.touch = if touch.is_some() {
                    found.len() as u32
                } else {
                    NONE
                };
                found.extend(touch);
            }
            Ok(found)
        })
    };
    let chunks: Vec<Result<Vec<Touch>>> = if pairs.len() <= CHUNK || threads == 1 {
        pairs.chunks_mut(CHUNK).map(run).collect()
    } else {
        pairs.par_chunks_mut(CHUNK).map(run).collect()
    };
    let mut touches = Vec::new();
    for (chunk, pairs) in chunks.into_iter().zip(pairs.chunks_mut(CHUNK)) {
        let chunk = chunk?;
        for pair in pairs.iter_mut().filter(|pair| pair.touch != NONE) {
            pair.touch += touches.len() as u32;
        }
        touches.extend(chunk);
    }
    Ok(touches)
}

impl Scene<'_> {
    fn pair(&self, resolver: &mut Resolver, pair: &mut Pair) -> Result<Option<Touch>> {
        let before = (pair.touch != NONE).then(|| &self.touches[pair.touch as usize]);
        let blocks = pair.parts.map(|part| self.parts.block[part as usize]);
        if blocks.iter().all(|&b| self.rests(b as usize)) {
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
        let verdict = resolver
            .resolve(first, second, &mut pair.cache)
            .map_err(|error| {
                let [a, b] = blocks.map(|block| self.name(block));
                Error::scene(format!("{a} and {b}"), error.to_string())
            })?;
        Ok(match verdict {
            Verdict::Apart => None,
            Verdict::Touching => before.map(|touch| Touch {
                overlap: 0.0,
                area: 0.0,
                force: law::Force {
                    history: touch.force.history,
                    ..law::Force::default()
                },
                ..*touch
            }),
            Verdict::Contact(contact)
                if contact.overlap > TENTHS * self.largest_overlap * contact.limit =>
            {
                return Err(Error::DeepOverlap {
                    first: self.name(blocks[0]),
                    second: self.name(blocks[1]),
                    depth: contact.overlap,
                    limit: TENTHS * self.largest_overlap * contact.limit,
                    remedy: "take a greater normal_stiffness, press them together more slowly, or \
                             allow a greater largest_overlap"
                        .into(),
                });
            }
            Verdict::Contact(contact) => Some(self.touch(pair.parts, blocks, &contact, before)),
        })
    }

    fn rests(&self, block: usize) -> bool {
        self.states[block].asleep || self.bodies[block].is_fixed()
    }

    fn touch(
        &self,
        parts: [u32; 2],
        blocks: [u32; 2],
        contact: &Contact,
        before: Option<&Touch>,
    ) -> Touch {
        let [a, b] = blocks.map(|block| block as usize);
        let (first, second) = (&self.bodies[a], &self.bodies[b]);
        let joint = self.joints.of(first.material, second.material);
        let at = contact.pressure_centre;
        let [fa, fb] = [a, b].map(|block| &self.flights[block]);
        let [ra, rb] = [a, b].map(|block| at - self.states[block].centre);
        let mean = fb.velocity + fb.spin.cross(rb) - fa.velocity - fa.spin.cross(ra);
        let end = fb.end_velocity + fb.end_spin.cross(rb) - fa.end_velocity - fa.end_spin.cross(ra);
        let motion = law::Motion {
            way: mean * self.time_step,
            velocity: end,
            spin: fb.spin - fa.spin,
            frame: self.states[a].rotation,
            time_step: self.time_step,
            mass: 1.0 / (first.inverse_mass() + second.inverse_mass()),
        };
        let section = law::Section {
            normal: contact.normal,
            overlap: contact.overlap,
            area: contact.area,
        };
        let fresh = History {
            bonded: self.bonding,
            ..History::default()
        };
        let history = before.map_or(fresh, |touch| touch.force.history);
        Touch {
            parts,
            blocks,
            point: contact.point,
            pressure_centre: at,
            normal: contact.normal,
            overlap: contact.overlap,
            area: contact.area,
            width: contact.width,
            limit: contact.limit,
            force: law::force(joint, &section, &motion, &history),
            stored: before.map_or(0.0, |touch| touch.stored),
            power: before.map_or(0.0, |touch| touch.power),
        }
    }

    fn name(&self, block: u32) -> String {
        label(block as usize, &self.bodies[block as usize].name)
    }
}

/// A block in a message.
pub(super) fn label(index: usize, name: &str) -> String {
    format!("blocks[{index}] ({name})")
}
