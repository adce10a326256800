//! The result, for people and for programs: `threshold.csv` and `threshold.json`.

use super::{Args, Equilibrium, Motion, Trial, trial::BEGUN};
use crate::print::percent;
use riprap::output::replace;
use serde::Serialize;
use std::{
    fmt,
    path::{Path, PathBuf},
};

/// All trials, and the resulting bracket.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The scene's file.
    pub scene: PathBuf,
    /// The numbers that were changed.
    pub keys: Vec<String>,
    /// Requested width of the bracket.
    pub tolerance: f64,
    /// The trials in their order.
    pub trials: Vec<Trial>,
    /// The value at which no block moves, and the one at which one does, once both have been tried.
    pub bracket: Option<[f64; 2]>,
    /// If a block was under way at the still end of the bracket: the nearest value at which no block reached a tenth of the
    /// motion criterion.
    pub rest: Option<f64>,
    /// With `--equilibrium`: the limit equilibrium under the mean loads at the still end of the bracket.
    pub equilibrium: Option<Equilibrium>,
    /// Whether the bracket is as narrow as requested.
    pub complete: bool,
    /// Why the bracket is uncertain, if it is.
    pub warning: Option<String>,
}

impl Report {
    /// The report before the first trial.
    pub fn new(args: &Args) -> Self {
        Self {
            scene: args.scene.clone(),
            keys: args.key.clone(),
            tolerance: args.tolerance,
            trials: Vec::new(),
            bracket: None,
            rest: None,
            equilibrium: None,
            complete: false,
            warning: None,
        }
    }

    /// Stores the results of the trials.
    pub fn end(&mut self, bracket: Option<[f64; 2]>, complete: bool) {
        (self.bracket, self.complete) = (bracket, complete);
        let at = |value| self.trials.iter().find(|trial| trial.value == value);
        let still = bracket.and_then(|[still, _]| at(still));
        self.equilibrium = still.and_then(|trial| trial.equilibrium.clone());
        self.warning = bracket.and_then(|[still, moves]| {
            let ended = self.trials.iter().find(|trial| trial.value == still)?;
            let motion = ended.closest.as_ref().filter(|_| ended.under_way)?;
            let begun = |motion: &Motion| motion.part >= BEGUN;
            let rested = |t: &&Trial| t.moved.is_none() && !t.closest.as_ref().is_some_and(begun);
            let values = self.trials.iter().filter(rested).map(|trial| trial.value);
            self.rest = values.min_by(|a, b| (a - moves).abs().total_cmp(&(b - moves).abs()));
            let rest = self.rest.map(|rest| format!("; at {rest} none came to a tenth of it"));
            Some(format!(
                "at {still} {} was under way when the trial ended, by {} of what counts as motion: more --steps, or a \
                 smaller --distance or --speed, {} the threshold{}",
                motion.block,
                percent(motion.part),
                if still > moves { "raise" } else { "lower" },
                rest.unwrap_or_default()
            ))
        });
    }

    /// Writes both files into `folder`.
    pub fn write(&self, folder: &Path) -> anyhow::Result<()> {
        let json = serde_json::to_string_pretty(self)? + "\n";
        replace(&folder.join("threshold.json"), |file| {
            file.write_all(json.as_bytes())
        })?;
        let mut table = String::from("trial,value,moved,time,distance,speed,steps,seconds,block\n");
        for (number, trial) in self.trials.iter().enumerate() {
            let motion = trial.moved.as_ref().or(trial.closest.as_ref());
            let [time, distance, speed] = motion.map_or([f64::NAN; 3], |motion| {
                [motion.time, motion.distance, motion.speed]
            });
            table += &format!(
                "{number},{},{},{time},{distance},{speed},{},{},{}\n",
                trial.value,
                u8::from(trial.moved.is_some()),
                trial.steps,
                trial.seconds,
                motion.map_or("", |motion| &motion.block)
            );
        }
        replace(&folder.join("threshold.csv"), |file| {
            file.write_all(table.as_bytes())
        })?;
        Ok(())
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let keys = self.keys.join(", ");
        match self.bracket {
            Some([still, moves]) => write!(
                f,
                "{keys}: no block moves at {still}, one does at {moves}; the threshold is {} ± {:.2e}, \
                 after {} trials{}",
                0.5 * (still + moves),
                0.5 * (moves - still).abs(),
                self.trials.len(),
                if self.complete { "" } else { ", stopped" }
            )
            .and_then(|()| match &self.equilibrium {
                Some(found) => write!(f, "\n{found}"),
                None => Ok(()),
            })
            .and_then(|()| match &self.warning {
                Some(warning) => write!(f, "\nwarning: {warning}"),
                None => Ok(()),
            }),
            None => write!(f, "{keys}: stopped before both ends were tried"),
        }
    }
}
