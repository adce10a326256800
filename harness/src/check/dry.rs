//! What a scene of blocks alone will run.

use super::{BlockFacts, lines::Lines};
use crate::{
    print::duration,
    search::{self, Finder},
};
use anyhow::Result;
use riprap::{scene::Scene, simulation::Dry};
use serde::Serialize;
use std::{
    path::Path,
    time::{Duration, Instant},
};

/// Length of the trial.
const TRIAL: Duration = Duration::from_millis(400);

/// All that `riprap check` says of blocks alone.
#[derive(Debug, Serialize)]
pub struct RockReport {
    /// Title of the scene.
    pub title: String,
    /// The blocks.
    #[serde(flatten)]
    pub facts: BlockFacts,
    /// Where pairs are searched.
    pub search: String,
    /// Step of the run, s.
    pub time_step: f64,
    /// Whether the scene gave the time step.
    pub given: bool,
    /// Steps of the run.
    pub steps: u64,
    /// Simulated time of the run, s.
    pub duration: f64,
    /// What may disappoint.
    pub warnings: Vec<String>,
    /// One step, s.
    pub step_seconds: f64,
    /// The run without its output, s.
    pub run_seconds: f64,
    /// Steps of the trial.
    pub trial_steps: u64,
}

/// Makes the blocks of `scene`, which was read from `file`, and tries a few steps.
///
/// # Errors
/// What the scene lacks.
pub fn report(scene: &Scene, file: &Path, adapter: Option<&str>) -> Result<RockReport> {
    let mut simulation = search::open(scene, file, adapter)?;
    let time_step = simulation.time_step();
    let steps = scene.run.count(time_step);
    let (trial, spent) = try_out(&mut simulation, steps)?;
    let shown = &simulation.setup().blocks;
    let (blocks, left_out) = (simulation.blocks(), simulation.left_out());
    let step = spent / trial as f64;
    Ok(RockReport {
        title: scene.title.clone(),
        facts: BlockFacts::of(shown, blocks, left_out, time_step),
        search: simulation.finder().describe(),
        time_step,
        given: scene.rock.time_step.is_some(),
        steps,
        duration: scene.run.length(time_step),
        warnings: scene
            .slips(time_step)
            .iter()
            .map(ToString::to_string)
            .collect(),
        step_seconds: step,
        run_seconds: step * steps as f64,
        trial_steps: trial,
    })
}

/// Steps for less than half a second, at least one: how many, and how long they took, s.
fn try_out(simulation: &mut Dry<Finder>, most: u64) -> Result<(u64, f64)> {
    // The first step finds all pairs and their contacts anew.
    search::drive(simulation, 1)?;
    let start = Instant::now();
    let mut done = 0;
    while done == 0 || (done < most && start.elapsed() < TRIAL) {
        search::drive(simulation, 1)?;
        done += 1;
    }
    Ok((done, start.elapsed().as_secs_f64()))
}

impl RockReport {
    /// The report in lines of a name and what there is of it.
    pub fn text(&self) -> String {
        let mut lines = Lines::titled(&self.title);
        self.facts.lines(&mut lines);
        lines.add("search", &self.search);
        lines.add(
            "time",
            format_args!(
                "{} steps of {:.4e} s = {:.4} s",
                self.steps, self.time_step, self.duration
            ),
        );
        lines.add(
            "stability",
            match self.given {
                true => "the time step is the scene's; one too long is refused",
                false => "sub-steps take half of the longest stable one",
            },
        );
        lines.add(
            "run",
            format_args!(
                "about {} without output: {:.3e} s a step ({} steps tried)",
                duration(self.run_seconds),
                self.step_seconds,
                self.trial_steps
            ),
        );
        lines.warnings(&self.warnings);
        lines.text()
    }
}
