//! A short trial of a scene, from which its running time follows.

use crate::run::SceneRun;
use riprap::{Result, simulation::Kind};
use std::time::{Duration, Instant};

/// Length of the trial: enough that the start of a submission, some 0.1 ms, does not count.
const LENGTH: Duration = Duration::from_millis(400);

/// The steps that were timed.
pub struct Trial {
    /// How many.
    pub steps: u64,
    /// How long they took, s.
    pub seconds: f64,
    /// How the trial ended, if it did so early.
    pub ended: Result<()>,
}

impl Trial {
    /// Runs steps for less than half a second, at least one.
    pub fn of(run: &mut SceneRun) -> Self {
        let mut trial = Self {
            steps: 0,
            seconds: 0.0,
            ended: Ok(()),
        };
        trial.ended = trial.run(run);
        trial
    }

    fn run(&mut self, run: &mut SceneRun) -> Result<()> {
        let kind = run.simulation.kind();
        let before = match kind {
            // Drivers compile at the first dispatch, and the first step has no boundary passes.
            Kind::Lattice => 4,
            // The first step finds all pairs and their contacts anew.
            Kind::Rock | Kind::Particles => 1,
        };
        // What comes after the run may fail though the run does not.
        let of_run = run.scene().run.count(run.time_step());
        let most = of_run.saturating_sub(before).max(1);
        run.advance(before)?;
        let mut left = LENGTH;
        let mut batch = 1;
        loop {
            let start = Instant::now();
            run.advance(batch)?;
            let took = start.elapsed();
            self.steps += batch;
            self.seconds += took.as_secs_f64();
            left = left.saturating_sub(took);
            // The next batch is twice as long.
            if left < 2 * took || self.steps >= most {
                break;
            }
            batch = (2 * batch).min(most - self.steps);
        }
        match kind {
            // What is recorded is done once it can be read.
            Kind::Particles => run.water().map(drop),
            Kind::Lattice | Kind::Rock => Ok(()),
        }
    }

    /// A step, s.
    pub fn step(&self) -> f64 {
        self.seconds / self.steps.max(1) as f64
    }
}
