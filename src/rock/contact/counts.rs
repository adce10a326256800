//! How pairs were decided.

use std::ops::AddAssign;

/// Numbers of pairs by what decided them, and of the work done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Pairs seen.
    pub pairs: u64,
    /// Apart by their bounding spheres.
    pub bounds: u64,
    /// Apart by the cached plane.
    pub planes: u64,
    /// In contact by the cached point.
    pub points: u64,
    /// Decided by a face, or by the line of centres.
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
