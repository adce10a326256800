//! Steps of several worlds in turns, so that a busy minute strikes all of them alike.

use super::{super::median, World};
use crate::{bench::Bench, gpu};
use kit::clock::{Clock, PATIENCE};
use riprap::simulation::Simulation;
use std::time::Instant;

/// How turns are taken.
pub struct Turns {
    pub clock: Clock,
    pub rounds: usize,
    /// How long a turn should be, s.
    long: f64,
}

/// Seconds of a step of each world in each round.
pub struct Times(Vec<Vec<f64>>);

impl Times {
    /// The median of one world.
    pub fn median(&self, world: usize) -> f64 {
        median(self.0[world].clone())
    }

    /// Median of the ratios of two worlds in the same round.
    pub fn ratio(&self, world: usize, base: usize) -> f64 {
        let pairs = self.0[world].iter().zip(&self.0[base]);
        median(pairs.map(|(a, b)| a / b).collect())
    }
}

impl Turns {
    pub fn new(bench: &Bench<'_>, rounds: usize, long: f64) -> Self {
        Self {
            clock: bench.clock(),
            rounds,
            long,
        }
    }

    /// Seconds of `work`, as speeds are made from.
    ///
    /// # Errors
    /// Those of `work`.
    pub fn time(&self, work: impl FnOnce() -> anyhow::Result<()>) -> anyhow::Result<f64> {
        Ok(self.clock.basis(self.clock.time(work)?))
    }

    /// Makes the worlds and steps them in turns.
    ///
    /// # Errors
    /// If the device fails.
    pub fn measure(&self, worlds: &mut [World]) -> anyhow::Result<Times> {
        let (device, queue) = (&self.clock.device, &self.clock.queue);
        let mut steps = Vec::new();
        for world in worlds.iter_mut() {
            let made = Simulation::new(device, queue, &world.scene);
            let made = gpu::drive(device, PATIENCE, "the kernels", made)??;
            world.simulation = Some(made);
            // The first ones compile, and blocks find their tiles.
            self.steps(world, 4)?;
            let begin = Instant::now();
            self.steps(world, 2)?;
            let seconds = begin.elapsed().as_secs_f64() / 2.0;
            steps.push(((self.long / seconds) as u64).clamp(2, 200));
        }
        // The same number for all: what a submission costs is then the same part of each.
        let steps = steps.into_iter().min().unwrap_or(2);
        let mut times = vec![Vec::new(); worlds.len()];
        for _ in 0..self.rounds {
            for (world, times) in worlds.iter_mut().zip(&mut times) {
                let spent = self.time(|| self.steps(world, steps))?;
                times.push(spent / steps as f64);
            }
        }
        Ok(Times(times))
    }

    fn steps(&self, world: &mut World, steps: u64) -> anyhow::Result<()> {
        if let Some(simulation) = &mut world.simulation {
            let done = simulation.advance(steps);
            gpu::drive(&self.clock.device, PATIENCE, "blocks in a fluid", done)??;
        }
        Ok(())
    }
}
