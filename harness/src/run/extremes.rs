//! Extremes of a run next to its checkpoint, so that a restart continues them.

use super::{recorder::RunLog, rock::Safety};
use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Extremes until a step. TOML holds infinite and unknown numbers too.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Extremes {
    step: u64,
    /// Of the fluid, m/s.
    max_speed: f64,
    /// Of the blocks, m/s.
    block_speed: f64,
    #[serde(default)]
    safety: Vec<Safety>,
}

/// Path of the extremes at the checkpoint at `path`.
fn beside(path: &Path) -> PathBuf {
    path.with_extension("extremes.toml")
}

/// Keeps the extremes of `log` until `step`, at the checkpoint at `path`.
pub fn keep(path: &Path, step: u64, log: &RunLog) -> Result<()> {
    let text = toml::to_string(&Extremes {
        step,
        max_speed: log.max_speed,
        block_speed: log.block_speed,
        safety: log.safety.clone(),
    })?;
    riprap::output::replace(&beside(path), |file| file.write_all(text.as_bytes()))?;
    Ok(())
}

/// Continues in `log` the extremes that are kept at the checkpoint at `path`, which is of `step`.
pub fn resume(path: &Path, step: u64, log: &mut RunLog) {
    match read(path, step) {
        Ok(found) => {
            log.max_speed = found.max_speed;
            log.block_speed = found.block_speed;
            log.safety = found.safety;
        }
        Err(error) => log.warnings.push(format!(
            "the largest speeds and least factors of safety of the summary are those since step {step}: {error:#}"
        )),
    }
}

fn read(path: &Path, step: u64) -> Result<Extremes> {
    let path = beside(path);
    let name = || path.display().to_string();
    let found: Extremes =
        toml::from_str(&fs::read_to_string(&path).with_context(name)?).with_context(name)?;
    anyhow::ensure!(found.step == step, "{} is of step {}", name(), found.step);
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::rock::Factors;

    #[test]
    fn what_is_kept_goes_on_and_what_is_of_another_step_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("checkpoint.riprap");
        let factors = Factors {
            sliding: 1.25,
            uplift: f64::INFINITY,
            toppling: 2.0,
        };
        let log = RunLog {
            max_speed: 3.5,
            block_speed: 0.25,
            safety: vec![Safety {
                block: "slab".into(),
                time: 0.5,
                last: factors,
                least: factors,
            }],
            ..RunLog::default()
        };
        keep(&path, 7, &log).unwrap();
        let resumed = |step| {
            let mut log = RunLog::default();
            resume(&path, step, &mut log);
            log
        };
        let same = resumed(7);
        assert_eq!((same.max_speed, same.block_speed), (3.5, 0.25));
        assert_eq!(same.safety, log.safety);
        assert!(same.warnings.is_empty());
        let other = resumed(8);
        assert_eq!(other.max_speed, 0.0);
        assert!(
            other.warnings[0].contains("is of step 7"),
            "{:?}",
            other.warnings
        );
        folder.close().unwrap();
        assert!(resumed(7).warnings[0].contains("checkpoint.extremes.toml"));
    }
}
