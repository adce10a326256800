//! A short trial of a scene, from which its running time follows.

use crate::run::SceneRun;
use riprap::{Result, simulation::Kind};
use std::time::{Duration, Instant};

/// Length of the trial: the start of a submission, some 0.1 ms, is negligible against it.
const LENGTH: Duration = Duration::from_millis(400);

/// The steps that were timed.
pub struct Trial {
    /// Number of steps.
    pub steps: u64,
    /// Time that they took, s.
    pub seconds: f64,
    /// The error that ended the trial early, if any.
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
            // Drivers compile kernels at the first dispatch, and the first step has no boundary passes.
            Kind::Lattice => 4,
            // The first step searches all pairs and contacts from scratch.
            Kind::Rock | Kind::Particles => 1,
        };
        // Not beyond the end of the run, where steps may fail that the run does not take.
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
            // Reading the water waits for the recorded steps.
            Kind::Particles => run.water().map(drop),
            Kind::Lattice | Kind::Rock => Ok(()),
        }
    }

    /// Time per step, s.
    pub fn step(&self) -> f64 {
        self.seconds / self.steps.max(1) as f64
    }
}
