//! Contacts per second on one core: a settled pile with warm caches, and every pair with an empty cache.
//!
//! An iteration is a step: every candidate pair once. Times are the CPU time of the thread, so that other
//! programs do not affect them. At the end it prints which tests decided the pairs, and the rates of pairs and contacts.

use cpu_time::ThreadTime;
use criterion::{Criterion, Throughput};
use glam::{DQuat, DVec3};
use kit::contact::{Couple, Random, Solid};
use riprap::{
    Result,
    rock::contact::{Cache, Counts, Normal, Options, Placed, Resolver, Verdict},
};
use std::time::Duration;

/// Motion per step, in L and rad, of a settled pile and of a moving one.
const SETTLED: f64 = 1e-5;
const MOVING: f64 = 1e-3;
/// Steps of the motion, which is repeated forwards and backwards.
const STEPS: usize = 16;
/// Overlap of neighbours at rest, in L.
const OVERLAP: f64 = 1e-4;
/// Boxes along an edge of the pile.
const SIDE: usize = 6;

/// A block in the pile.
struct Resting {
    solid: Solid,
    centre: DVec3,
    rotation: DQuat,
}

/// Candidate pairs, and the blocks at their poses in each step.
struct Pile {
    pairs: Vec<[u32; 2]>,
    steps: Vec<Vec<Placed>>,
}

impl Pile {
    fn new(blocks: &[Resting], pairs: Vec<[u32; 2]>, motion: f64) -> Self {
        let mut random = Random(7);
        let mut moved = vec![(DVec3::ZERO, DVec3::ZERO); blocks.len()];
        let steps = (0..STEPS).map(|_| {
            let placed = blocks.iter().zip(&mut moved).map(|(block, (way, turn))| {
                *way += random.vector() * motion;
                *turn += random.vector() * motion;
                let rotation = DQuat::from_scaled_axis(*turn) * block.rotation;
                block.solid.at(block.centre + *way, rotation)
            });
            placed.collect()
        });
        Self {
            steps: steps.collect(),
            pairs,
        }
    }

    /// Boxes on a lattice; pairs share a face, an edge or a corner.
    fn boxes() -> Self {
        let cells = || (0..SIDE.pow(3)).map(|k| [k % SIDE, k / SIDE % SIDE, k / SIDE / SIDE]);
        let edges = DVec3::new(1.0, 0.8, 0.6);
        let blocks: Vec<_> = cells()
            .map(|cell| Resting {
                solid: Solid::cuboid(edges),
                centre: DVec3::from_array(cell.map(|c| c as f64)) * (edges - OVERLAP),
                rotation: DQuat::IDENTITY,
            })
            .collect();
        let near = |a: [usize; 3], b: [usize; 3]| (0..3).all(|k| a[k].abs_diff(b[k]) <= 1);
        let mut pairs = Vec::new();
        for (i, a) in cells().enumerate() {
            let later = cells().enumerate().skip(i + 1);
            pairs.extend(
                later
                    .filter(|(_, b)| near(a, *b))
                    .map(|(j, _)| [i as u32, j as u32]),
            );
        }
        Self::new(&blocks, pairs, SETTLED)
    }

    /// Random pairs with the two `gaps` alternately; a negative gap is an overlap.
    fn couples(gaps: [f64; 2], motion: f64) -> Self {
        let mut random = Random(3);
        let mut blocks = Vec::new();
        let mut pairs = Vec::new();
        for k in 0..600 {
            let couple = Couple::random(&mut random, 1.0, gaps[k % 2]);
            pairs.push([blocks.len() as u32, blocks.len() as u32 + 1]);
            for (place, solid) in couple.solids.into_iter().enumerate() {
                blocks.push(Resting {
                    solid,
                    centre: couple.centres[place],
                    rotation: couple.rotations[place],
                });
            }
        }
        Self::new(&blocks, pairs, motion)
    }

    /// Resolves all pairs of a step; returns the number of contacts.
    fn step(&self, resolver: &mut Resolver, caches: &mut [Cache], step: usize) -> Result<u64> {
        let cycle = step % (2 * STEPS - 2);
        let placed = &self.steps[cycle.min(2 * STEPS - 2 - cycle)];
        let mut contacts = 0;
        for ([i, j], cache) in self.pairs.iter().zip(caches) {
            let (a, b) = (&placed[*i as usize], &placed[*j as usize]);
            contacts += u64::from(matches!(
                resolver.resolve(a, b, cache)?,
                Verdict::Contact(_)
            ));
        }
        Ok(contacts)
    }
}

/// Times steps and prints rates; `cold` empties the caches before each step.
fn measure(criterion: &mut Criterion, name: &str, pile: &Pile, options: Options, cold: bool) {
    let mut resolver = Resolver::new(options);
    let mut caches = vec![Cache::default(); pile.pairs.len()];
    let mut run = |steps: std::ops::Range<usize>| {
        let mut contacts = 0;
        let start = ThreadTime::now();
        for step in steps {
            if cold {
                caches.fill(Cache::default());
            }
            contacts += pile
                .step(&mut resolver, &mut caches, step)
                .expect("a finite pile");
        }
        (start.elapsed(), contacts, resolver.counts())
    };
    // One full cycle of the motion builds the solvers and fills the caches.
    let (_, _, before) = run(0..2 * STEPS);
    let mut total = (Duration::ZERO, 0, before);
    let mut next = 2 * STEPS;
    let mut group = criterion.benchmark_group("contact");
    group.throughput(Throughput::Elements(pile.pairs.len() as u64));
    group.bench_function(name, |bencher| {
        bencher.iter_custom(|count| {
            let (time, contacts, counts) = run(next..next + count as usize);
            next += count as usize;
            total = (total.0 + time, total.1 + contacts, counts);
            time
        });
    });
    group.finish();
    // There are no contacts if the command line excludes this bench.
    if total.1 > 0 {
        report(name, total, before);
    }
}

fn report(name: &str, (time, contacts, after): (Duration, u64, Counts), before: Counts) {
    let pairs = (after.pairs - before.pairs) as f64;
    let share = |later: u64, earlier: u64| 100.0 * (later - earlier) as f64 / pairs;
    println!(
        "contact/{name}: {:.0} contacts/s, {:.0} pairs/s; bounds {:.1} %, plane {:.1} %, point {:.1} %, guess {:.1} %, program {:.2} %; {:.2} Newton steps a contact\n",
        contacts as f64 / time.as_secs_f64(),
        pairs / time.as_secs_f64(),
        share(after.bounds, before.bounds),
        share(after.planes, before.planes),
        share(after.points, before.points),
        share(after.guesses, before.guesses),
        share(after.programs, before.programs),
        (after.newton_steps - before.newton_steps) as f64 / contacts as f64,
    );
}

fn main() {
    let mut criterion = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(600))
        .configure_from_args();
    let barrier = Options::default();
    let potential = Options {
        normal: Normal::Potential,
    };
    let boxes = Pile::boxes();
    let pressed = Pile::couples([-OVERLAP; 2], SETTLED);
    let mixed = Pile::couples([-OVERLAP, OVERLAP], SETTLED);
    let moving = Pile::couples([-10.0 * OVERLAP, 10.0 * OVERLAP], MOVING);
    measure(&mut criterion, "settled boxes", &boxes, barrier, false);
    measure(
        &mut criterion,
        "settled polyhedra",
        &pressed,
        barrier,
        false,
    );
    measure(
        &mut criterion,
        "settled polyhedra, potential normal",
        &pressed,
        potential,
        false,
    );
    measure(&mut criterion, "moving polyhedra", &moving, barrier, false);
    measure(&mut criterion, "cold boxes", &boxes, barrier, true);
    measure(&mut criterion, "cold polyhedra", &mixed, barrier, true);
    criterion.final_summary();
}
