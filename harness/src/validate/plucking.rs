//! The velocity at which the block of the scene `plucking` begins to move, compared with that of limit equilibrium under the mean
//! pressures on its faces.

use super::{CaseContext, Outcome, Trial};
use crate::threshold::{self, Args, mean_and_error};
use anyhow::Context;
use std::{fs, sync::atomic::AtomicBool, time::Instant};

/// The bundled scene, with 16 cells across the block.
const SCENE: &str = include_str!("../../scenes/plucking.toml");
/// Velocity outside the boundary layer in the scene, m/s; the search varies a factor on the velocity profile.
const VELOCITY: f64 = 4.0;
/// Times for which the block is held, s: each releases it into different eddies.
const HOLDS: [f64; 3] = [0.05, 0.09, 0.13];
/// Time for which the block is free to move, s.
const FREE: f64 = 0.3;
/// Factors on the profile at which the block stays and at which it moves, and the tolerance of the search between them.
const ENDS: [f64; 2] = [0.3, 0.5];
const TOLERANCE: f64 = 0.015;

/// Runs the case.
pub fn run(context: &CaseContext) -> Outcome {
    let folder = tempfile::tempdir().context("cannot make a temporary folder")?;
    let mut records = Vec::new();
    let begin = Instant::now();
    let [mut moves, mut fails] = [Vec::new(), Vec::new()];
    let mut half_bracket = 0.0_f64;
    for hold in HOLDS {
        let text = SCENE
            .replace("hold = 0.05", &format!("hold = {hold}"))
            .replace("duration = 0.35", &format!("duration = {}", hold + FREE));
        let scene = folder.path().join("plucking.toml");
        fs::write(&scene, text).with_context(|| format!("cannot write {}", scene.display()))?;
        let args = Args {
            scene,
            key: ["boundaries.x_min.velocity[0]", "initial.velocity[0]"]
                .map(String::from)
                .into(),
            from: ENDS[0],
            to: ENDS[1],
            tolerance: TOLERANCE,
            equilibrium: true,
            adapter: Some(context.device.adapter_info().name),
            out: Some(folder.path().into()),
            ..Args::default()
        };
        let start = Instant::now();
        let report = threshold::run(&args, &AtomicBool::new(false))?;
        let steps = report.trials.iter().map(|trial| trial.steps).sum();
        let what = format!("plucking, held for {hold} s");
        let trial = Trial::since(start, what, 96 * 32 * 48, steps);
        let [still, moving] = report.bracket.context("no bracket")?;
        let name = |what: &str| format!("{what}, held for {hold} s, m/s");
        moves.push(0.5 * VELOCITY * (still + moving));
        let half = 0.5 * VELOCITY * (moving - still);
        records.push(trial.report(name("least velocity that moves it"), moves[moves.len() - 1]));
        half_bracket = half_bracket.max(half);
        records.push(trial.report(name("half the bracket of that"), half));
        let found = report.equilibrium.context("it stands in any flow")?;
        fails.push(VELOCITY * found.value);
        let fails = format!("limit equilibrium of mean loads, by {}", found.mode);
        records.push(trial.report(name(&fails), VELOCITY * found.value));
        if let Some(error) = found.error {
            records.push(trial.report(name("statistical error of that"), VELOCITY * error));
        }
    }
    let trial = Trial::since(begin, "plucking, from three moments", 96 * 32 * 48, 0);
    let of_all = |all: &[f64]| mean_and_error(all).context("a single moment");
    let (moves, fails) = (of_all(&moves)?, of_all(&fails)?);
    // A threshold is uniformly distributed in its bracket; the three brackets may coincide.
    let bracket = half_bracket / 3f64.sqrt();
    let mut add = |what: &str, value| records.push(trial.report(what, value));
    add("least velocity that moves it, mean, m/s", moves[0]);
    add(
        "its standard error, with that of the bracket, m/s",
        moves[1].hypot(bracket),
    );
    add("limit equilibrium of mean loads, mean, m/s", fails[0]);
    add("standard error of that limit, m/s", fails[1]);
    add(
        "velocity that moves it / limit equilibrium",
        moves[0] / fails[0],
    );
    Ok(records)
}
