//! Piles at rest: their contacts with warm and with cold caches, the step of all of their blocks, and the split of its time.

use super::{Basis, Core, Plan, Row, fastest};
use glam::{DMat3, DQuat, DVec3};
use kit::{
    clock::{Spent, Stopwatch},
    pile::Pile,
};
use riprap::{
    Result,
    rock::{
        broadphase::{Broadphase, HostBroadphase},
        contact::{Cache, Counts, Options, Placed, Resolver, Verdict},
        law::{self, History, Motion, Section},
    },
};
use serde::Serialize;
use std::{fmt, hint::black_box};

/// Variant of the contact: with the caches of the previous step.
pub const WARM: &str = "pile at rest, warm";
/// Variant of the contact: with empty caches.
pub const COLD: &str = "pile at rest, cold";
/// A variant of the step.
pub const ONE_CORE: &str = "pile at rest, one core";
/// Successive steps whose pairs are resolved, back and forth.
const FRAMES: usize = 4;

/// Measures contacts, warm and cold, and the step, for each number of blocks.
pub fn measure(plan: &Plan, core: &Core, rows: &mut Vec<Row>) -> Result<()> {
    for &count in &plan.piles {
        let mut pile = Pile::settled(count)?;
        let speed = pile.blocks.largest_speed();
        println!(
            "pile of {} free blocks among {}: {speed:.1e} m/s after {} steps, {:.1e} m a step",
            pile.free,
            pile.blocks.len(),
            pile.steps,
            speed * pile.blocks.time_step()
        );
        let film = Film::new(&mut pile)?;
        for (variant, cold) in [(WARM, false), (COLD, true)] {
            let pairs = film.pairs.len();
            let (spent, contacts, programs) = film.resolve(core, |_| true, cold, plan.rounds)?;
            Row {
                pairs,
                contacts,
                share_of_programs: Some(programs),
                largest_speed: Some(pile.blocks.largest_speed()),
                ..Row::new("contact", variant, pile.free, spent, Basis::Cpu)
            }
            .push(rows);
        }
        steps(plan, core, &mut pile, &film, rows)?;
    }
    Ok(())
}

/// A candidate pair of a pile.
struct Pair {
    blocks: [u32; 2],
    /// Its cache after the first frame.
    cache: Cache,
    /// Whether it is in contact in the first frame.
    touches: bool,
}

/// The pairs of a pile, and its blocks as the resolver sees them in some steps.
struct Film {
    frames: Vec<Vec<Placed>>,
    pairs: Vec<Pair>,
}

impl Film {
    /// Records some steps of the pile.
    fn new(pile: &mut Pile) -> Result<Self> {
        let pairs = pollster::block_on(HostBroadphase.pairs(&pile.blocks.aabbs()))?;
        let mut frames = Vec::new();
        for _ in 0..FRAMES {
            pile.step()?;
            frames.push(pile.placed());
        }
        let mut resolver = Resolver::new(Options::default());
        let pair = |blocks: [u32; 2]| {
            let [a, b] = blocks.map(|block| &frames[0][block as usize]);
            let mut cache = Cache::default();
            let verdict = resolver.resolve(a, b, &mut cache)?;
            Ok(Pair {
                blocks,
                cache,
                touches: matches!(verdict, Verdict::Contact(_)),
            })
        };
        Ok(Self {
            pairs: pairs.into_iter().map(pair).collect::<Result<_>>()?,
            frames,
        })
    }

    /// Time of the `wanted` pairs on one core, their contacts, and the share of them that needs a linear program; `cold` empties
    /// their caches first.
    fn resolve(
        &self,
        core: &Core,
        wanted: impl Fn(&Pair) -> bool,
        cold: bool,
        rounds: usize,
    ) -> Result<(Spent, usize, f64)> {
        let pairs: Vec<&Pair> = self.pairs.iter().filter(|pair| wanted(pair)).collect();
        let mut caches: Vec<Cache> = pairs.iter().map(|pair| pair.cache).collect();
        let mut resolver = Resolver::new(Options::default());
        let (mut turn, mut contacts) = (0, 0);
        let mut pass = |resolver: &mut Resolver, caches: &mut [Cache]| -> Result<()> {
            let cycle = turn % (2 * FRAMES - 2);
            let placed = &self.frames[cycle.min(2 * FRAMES - 2 - cycle)];
            for (pair, cache) in pairs.iter().zip(caches) {
                let [a, b] = pair.blocks.map(|block| &placed[block as usize]);
                let verdict = resolver.resolve(a, b, cache)?;
                contacts += usize::from(matches!(verdict, Verdict::Contact(_)));
            }
            turn += 1;
            Ok(())
        };
        // Once back and forth: solvers are built and caches filled.
        for _ in 0..2 * FRAMES - 2 {
            pass(&mut resolver, &mut caches)?;
        }
        let before = resolver.counts();
        // A small set of pairs is resolved several times between two clock readings.
        let turns = (2000 / pairs.len().max(1)).max(1);
        let spent = fastest(rounds, turns, || {
            if cold {
                caches.fill(Cache::default());
            }
            core.time(|| pass(&mut resolver, &mut caches))
        })?;
        let programs = share_of_programs(before, resolver.counts());
        Ok((spent, contacts / turn.max(1), programs))
    }
}

/// Share of the pairs between two counts that needed a linear program.
fn share_of_programs(before: Counts, after: Counts) -> f64 {
    let pairs = (after.pairs - before.pairs).max(1);
    (after.programs - before.programs) as f64 / pairs as f64
}

/// Measures the whole step, on one core with its split, and on all cores.
fn steps(
    plan: &Plan,
    core: &Core,
    pile: &mut Pile,
    film: &Film,
    rows: &mut Vec<Row>,
) -> Result<()> {
    // Small piles step several times between two clock readings.
    let turns = (1000 / pile.free.max(1)).max(1);
    let (mut lists, mut taken) = (0, 0);
    let before = pile.blocks.counts();
    // One core first: a step then finds in the CPU cache its own data, not that of another core.
    let [one, all] = [true, false].map(|on_one| {
        fastest(plan.rounds, turns, || {
            lists += u32::from(pile.find_pairs()?);
            taken += 1;
            if on_one {
                return core.time(|| pile.blocks.step());
            }
            let watch = Stopwatch::start();
            pile.blocks.step()?;
            Ok(watch.spent())
        })
    });
    let (one, all) = (one?, all?);
    let programs = share_of_programs(before, pile.blocks.counts());
    let lists_a_step = f64::from(lists) / f64::from(taken);
    let split = Split::of(core, pile, film, one.cpu, lists_a_step, plan.rounds)?;
    for (variant, spent, basis, split) in [
        (ONE_CORE, one, Basis::Cpu, Some(split)),
        ("pile at rest, all cores", all, Basis::Wall, None),
    ] {
        Row {
            pairs: pile.blocks.candidate_pair_count(),
            contacts: pile.blocks.contacts().count(),
            share_of_programs: Some(programs),
            largest_speed: Some(pile.blocks.largest_speed()),
            split,
            ..Row::new("step", variant, pile.free, spent, basis)
        }
        .push(rows);
    }
    Ok(())
}

/// Parts of a step on one core, ms of CPU time, each measured separately on the same blocks.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Split {
    /// A new list of pairs: boxes, search, update. Not in every step.
    pub ms_broadphase: f64,
    /// Lists per step.
    pub lists_a_step: f64,
    /// Pairs that are not in contact.
    pub ms_decision: f64,
    /// Pairs in contact, as the cached point proves: centre, normal and section.
    pub ms_contact: f64,
    /// The force law of all contacts.
    pub ms_law: f64,
    /// A step of the same blocks without pairs: flight, placing, second kick, ledger.
    pub ms_motion: f64,
    /// The rest of the step: sums, ledger of the contacts, stability bound, lists.
    pub ms_rest: f64,
}

impl Split {
    /// Measures the parts of a step that takes `whole` s.
    fn of(
        core: &Core,
        pile: &mut Pile,
        film: &Film,
        whole: f64,
        lists_a_step: f64,
        rounds: usize,
    ) -> Result<Self> {
        let (contact, ..) = film.resolve(core, |pair| pair.touches, false, rounds)?;
        let (decision, ..) = film.resolve(core, |pair| !pair.touches, false, rounds)?;
        let broadphase = fastest(rounds, 1, || {
            core.time(|| {
                let pairs = pollster::block_on(HostBroadphase.pairs(&pile.blocks.aabbs()))?;
                pile.blocks.set_pairs(pairs)
            })
        })?;
        let sections = sections(pile);
        let joint = pile.joint();
        let law = fastest(rounds, 1, || {
            core.time(|| {
                for (section, motion, history) in &sections {
                    black_box(law::force(joint, section, motion, history));
                }
                Ok(())
            })
        })?;
        let mut apart = pile.apart()?;
        let motion = fastest(rounds, 1, || {
            if apart.needs_pairs() {
                apart.set_pairs(Vec::new())?;
            }
            core.time(|| apart.step())
        })?;
        let rest = whole - decision.cpu - contact.cpu - law.cpu - motion.cpu;
        Ok(Self {
            ms_broadphase: 1e3 * broadphase.cpu,
            lists_a_step,
            ms_decision: 1e3 * decision.cpu,
            ms_contact: 1e3 * contact.cpu,
            ms_law: 1e3 * law.cpu,
            ms_motion: 1e3 * motion.cpu,
            ms_rest: 1e3 * rest,
        })
    }
}

/// Arguments of the force law, for all contacts.
fn sections(pile: &Pile) -> Vec<(Section, Motion, History)> {
    let time_step = pile.blocks.time_step();
    let contacts = pile.blocks.contacts().map(|contact| {
        let section = Section {
            normal: contact.normal,
            overlap: contact.overlap,
            area: contact.area,
            elastic_area: contact.area,
            spread: DMat3::IDENTITY * (contact.area / 12.0),
            rolls: false,
            opening: 0.0,
        };
        let motion = Motion {
            displacement: 1e-8 * DVec3::ONE,
            velocity: 1e-4 * DVec3::ONE,
            spin: DVec3::ZERO,
            frame: DQuat::IDENTITY,
            time_step,
            mass: pile.blocks.mass(contact.blocks[0]),
        };
        let pressing = contact.force.dot(contact.normal);
        let history = History {
            shear: contact.force - pressing * contact.normal,
            normal: contact.normal,
            ..History::default()
        };
        (section, motion, history)
    });
    contacts.collect()
}

impl fmt::Display for Split {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "of it ms: decision {:.3}, contact {:.3}, law {:.3}, motion {:.3}, rest {:.3}; a list of pairs {:.3}, {:.3} lists a step",
            self.ms_decision,
            self.ms_contact,
            self.ms_law,
            self.ms_motion,
            self.ms_rest,
            self.ms_broadphase,
            self.lists_a_step
        )
    }
}
