//! Report on a scene of blocks alone.

use super::{BlockFacts, lines::Lines, trial::Trial};
use crate::{
    print::{duration, time},
    run::SceneRun,
};
use anyhow::{Context, Result};
use serde::Serialize;

/// What `riprap check` reports on blocks alone.
#[derive(Debug, Serialize)]
pub struct RockReport {
    /// Title of the scene.
    pub title: String,
    /// The blocks.
    #[serde(flatten)]
    pub facts: BlockFacts,
    /// Processor of the broadphase.
    pub search: String,
    /// Step of the run, s.
    pub time_step: f64,
    /// Whether the scene gave the time step.
    pub given: bool,
    /// Steps of the run.
    pub steps: u64,
    /// Simulated time of the run, s.
    pub duration: f64,
    /// Warnings about the scene.
    pub warnings: Vec<String>,
    /// Time that one step takes, s.
    pub step_seconds: f64,
    /// Time that the run takes without its output, s.
    pub run_seconds: f64,
    /// Steps of the trial.
    pub trial_steps: u64,
}

/// Runs a few steps of a scene of blocks alone and reports on them.
pub fn report(run: &mut SceneRun) -> Result<RockReport> {
    let time_step = run.time_step();
    let steps = run.scene().run.count(time_step);
    let trial = Trial::of(run);
    let step = trial.step();
    trial.ended?;
    let scene = run.scene();
    let rock = run.simulation.rock().context("the scene has no blocks")?;
    let setup = rock.setup();
    Ok(RockReport {
        title: scene.title.clone(),
        facts: BlockFacts::of(
            &setup.setup.blocks,
            rock.blocks(),
            &setup.left_out,
            time_step,
        ),
        search: run.describe_device(),
        time_step,
        given: scene.rock.time_step.is_some(),
        steps,
        duration: scene.run.length(time_step),
        warnings: run.warnings.clone(),
        step_seconds: step,
        run_seconds: step * steps as f64,
        trial_steps: trial.steps,
    })
}

impl RockReport {
    /// The report, one line per item.
    pub fn text(&self) -> String {
        let mut lines = Lines::titled(&self.title);
        self.facts.lines(&mut lines);
        lines.add("search", &self.search);
        lines.add(
            "time",
            format_args!(
                "{} steps of {:.4e} s = {}",
                self.steps,
                self.time_step,
                time(self.duration, 4)
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
                "about {} without output: {:.3e} s per step ({} steps tried)",
                duration(self.run_seconds),
                self.step_seconds,
                self.trial_steps
            ),
        );
        lines.warnings(&self.warnings);
        lines.text()
    }
}
