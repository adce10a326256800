//! A short trial of a scene, from which its running time follows.

use super::report::Time;
use crate::run::SceneRun;
use riprap::Result;
use std::time::{Duration, Instant};

/// Length of the trial: enough that the start of a submission, some 0.1 ms, does not count.
const TRIAL: Duration = Duration::from_millis(400);

/// Runs steps for less than half a second, at least one; says how the trial ended if it did so early.
pub fn time(run: &mut SceneRun) -> (Time, Result<()>) {
    let (mut done, mut spent) = (0, Duration::ZERO);
    let ended = tried(run, &mut done, &mut spent);
    let steps = run.scene().run.count(run.time_step());
    let step = spent.as_secs_f64() / done.max(1) as f64;
    let cells = run.lattice();
    let cells = cells.map_or(0, |(lattice, _)| lattice.geometry().fluid_cells) as f64;
    let time = Time {
        step,
        run: step * steps as f64,
        cells_a_second: if step > 0.0 { cells / step } else { 0.0 },
        trial_steps: done,
    };
    (time, ended)
}

fn tried(run: &mut SceneRun, done: &mut u64, spent: &mut Duration) -> Result<()> {
    let mut advance = |steps| {
        let start = Instant::now();
        run.advance(steps)?;
        Ok(start.elapsed())
    };
    // Drivers compile at the first dispatch, and the first step has no boundary passes.
    advance(4)?;
    let mut left = TRIAL;
    let mut turn = 1;
    loop {
        let took = advance(turn)?;
        (*done, *spent) = (*done + turn, *spent + took);
        left = left.saturating_sub(took);
        // The next turn is twice as long.
        if left < 2 * took {
            return Ok(());
        }
        turn *= 2;
    }
}
