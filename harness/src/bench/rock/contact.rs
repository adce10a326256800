//! Contacts of a pile: with the caches of the step before, and every pair for the first time.

use super::core::{Core, Cost};
use kit::pile::Pile;
use riprap::{
    Result,
    rock::{
        broadphase::{Broadphase, HostBroadphase},
        contact::{Cache, Counts, Options, Placed, Resolver, Verdict},
    },
};

/// Successive steps in which the pairs are looked at, gone to and fro.
const FRAMES: usize = 4;

/// The pairs of a pile and what the resolver sees of its blocks in some steps.
pub struct Film {
    frames: Vec<Vec<Placed>>,
    /// The pairs.
    pub pairs: Vec<[u32; 2]>,
    /// What each pair keeps.
    pub caches: Vec<Cache>,
}

/// What resolving all pairs once took and found.
#[derive(Clone, Copy, Debug)]
pub struct Resolved {
    /// Of all pairs once.
    pub cost: Cost,
    /// Contacts found.
    pub contacts: usize,
    /// Linear programs over pairs.
    pub share_of_programs: f64,
}

impl Film {
    /// Goes on with the pile for some steps.
    ///
    /// # Errors
    /// If a step fails.
    pub fn new(pile: &mut Pile) -> Result<Self> {
        let pairs = pollster::block_on(HostBroadphase.pairs(&pile.blocks.aabbs()))?;
        let mut frames = Vec::new();
        for _ in 0..FRAMES {
            pile.step()?;
            frames.push(pile.placed());
        }
        Ok(Self {
            caches: vec![Cache::default(); pairs.len()],
            frames,
            pairs,
        })
    }

    /// Resolves all pairs of a frame.
    fn pass(
        &self,
        turn: usize,
        pairs: &[[u32; 2]],
        resolver: &mut Resolver,
        caches: &mut [Cache],
    ) -> Result<usize> {
        let cycle = turn % (2 * FRAMES - 2);
        let placed = &self.frames[cycle.min(2 * FRAMES - 2 - cycle)];
        let mut contacts = 0;
        for ([i, j], cache) in pairs.iter().zip(caches) {
            let verdict = resolver.resolve(&placed[*i as usize], &placed[*j as usize], cache)?;
            contacts += usize::from(matches!(verdict, Verdict::Contact(_)));
        }
        Ok(contacts)
    }

    /// Fills the caches, and tells the pairs in contact in the first frame from the others.
    ///
    /// # Errors
    /// If a pose is not finite.
    pub fn sorted(&mut self) -> Result<[Vec<usize>; 2]> {
        let mut resolver = Resolver::new(Options::default());
        let mut found = [Vec::new(), Vec::new()];
        let placed = &self.frames[0];
        for (k, ([i, j], cache)) in self.pairs.iter().zip(&mut self.caches).enumerate() {
            let verdict = resolver.resolve(&placed[*i as usize], &placed[*j as usize], cache)?;
            found[usize::from(!matches!(verdict, Verdict::Contact(_)))].push(k);
        }
        Ok(found)
    }

    /// What the pairs of the indices `which` take on one core; `cold` empties their caches before.
    ///
    /// # Errors
    /// If a pose is not finite.
    pub fn measure(
        &self,
        core: &Core,
        which: &[usize],
        cold: bool,
        rounds: usize,
    ) -> Result<Resolved> {
        let pairs: Vec<_> = which.iter().map(|&k| self.pairs[k]).collect();
        let mut caches: Vec<_> = which.iter().map(|&k| self.caches[k]).collect();
        let mut resolver = Resolver::new(Options::default());
        // Once to and fro: solvers are built and caches filled.
        for turn in 0..2 * FRAMES - 2 {
            self.pass(turn, &pairs, &mut resolver, &mut caches)?;
        }
        let before = resolver.counts();
        let (mut cost, mut contacts, mut turn) = (Cost::NONE, 0, 0);
        // Few pairs are looked at several times between two looks at the clock.
        let turns = (2000 / pairs.len().max(1)).max(1);
        for _ in 0..rounds {
            let mut spent = Cost::ZERO;
            for _ in 0..turns {
                if cold {
                    caches.fill(Cache::default());
                }
                let (found, took) =
                    core.time(|| self.pass(turn, &pairs, &mut resolver, &mut caches))?;
                contacts += found;
                turn += 1;
                spent = spent.with(took);
            }
            cost = cost.lower(spent.of_each(turns));
        }
        Ok(Resolved {
            cost,
            contacts: contacts / turn.max(1),
            share_of_programs: share_of_programs(before, resolver.counts()),
        })
    }
}

/// Share of the pairs between two counts that took a linear program.
pub fn share_of_programs(before: Counts, after: Counts) -> f64 {
    let pairs = (after.pairs - before.pairs).max(1);
    (after.programs - before.programs) as f64 / pairs as f64
}
