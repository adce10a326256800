//! `--error-estimate`: runs the scene also at half the resolution, and reports the differences of its headline numbers.
//!
//! If the error scales with the cell size to the power p ≥ 1, the error of the run is the difference over 2^p − 1: at most
//! the difference itself.

mod coarse;
mod headline;

pub use headline::Headline;
pub(super) use headline::unit;

use super::{Args, Summary, computed, folder};
use crate::print::percent;
use anyhow::{Result, ensure};
use riprap::{Error, scene::Scene};
use serde::Serialize;
use std::{
    fmt,
    path::PathBuf,
    sync::atomic::{AtomicBool, Ordering},
};

/// Folder of the run at half the resolution, inside that of the run.
const FOLDER: &str = "half_resolution";
/// Number of lines printed to the terminal.
const SHOWN: usize = 30;

/// Differences of headline numbers from those at half the resolution.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Estimate {
    /// Description of half the resolution.
    pub resolution: String,
    /// Folder of that run.
    pub folder: PathBuf,
    /// Means over the last quarter of the run, and their differences.
    pub headlines: Vec<Headline>,
    /// Why there are no headline numbers, if so.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub missing: Option<String>,
}

/// Runs the scene at half its resolution and then as it is, and compares.
pub fn run(scene: &Scene, args: &Args, stop: &AtomicBool) -> Result<Summary> {
    if args.restart.is_some() {
        let message = "the scene at half its resolution has no such checkpoint; leave out `--restart` or \
            `--error-estimate`";
        return Err(Error::argument("--error-estimate", message).into());
    }
    let half = coarse::halved(scene, args)?;
    let folder = folder(args);
    let mut estimate = Estimate {
        resolution: half.says,
        folder: folder.join(FOLDER),
        ..Estimate::default()
    };
    let rough = Args {
        out: Some(estimate.folder.clone()),
        // `--steps` counts the steps of the finer run.
        steps: None,
        error_estimate: false,
        ..args.clone()
    };
    eprintln!("first at half the resolution, {}:", estimate.resolution);
    let coarse = computed(&half.scene, &rough, stop).map_err(|error| {
        let hint = match error.downcast_ref() {
            Some(Error::TimeStep { .. }) => {
                ": give the scene a rock.time_step of half the longest one named here"
            }
            _ => "",
        };
        error.context(format!(
            "at half the resolution, {}{hint}",
            estimate.resolution
        ))
    })?;
    eprintln!("then as it is:");
    let mut fine = computed(scene, args, stop)?;
    let compared = if stop.load(Ordering::Relaxed) {
        Err("the run was stopped".into())
    } else if coarse.diverged {
        Err("the run at half the resolution diverged".into())
    } else if fine.diverged {
        Err("the run diverged".into())
    } else {
        compare(scene, [&folder, &estimate.folder]).map_err(|error| format!("{error:#}"))
    };
    match compared {
        Ok(headlines) => estimate.headlines = headlines,
        Err(why) => estimate.missing = Some(why),
    }
    fine.error_estimate = Some(estimate);
    fine.write(&folder)?;
    Ok(fine)
}

/// The headline numbers of the tables in both folders.
fn compare(scene: &Scene, folders: [&PathBuf; 2]) -> Result<Vec<Headline>> {
    let names = headline::tables(scene);
    let mut all = Vec::new();
    for name in &names {
        all.extend(headline::of(name, folders)?);
    }
    ensure!(
        !all.is_empty(),
        "no probe or history of the scene has a single value per time; add [[probes]] or [[output.histories]]"
    );
    Ok(all)
}

impl fmt::Display for Estimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(why) = &self.missing {
            return write!(f, "  no estimate of the error: {why}");
        }
        write!(
            f,
            "  means of the last quarter ± their difference from half the resolution, {}:",
            self.resolution
        )?;
        let told: Vec<&Headline> = self.headlines.iter().filter(|h| !h.is_zero()).collect();
        for headline in told.iter().take(SHOWN) {
            write!(f, "\n    {headline}")?;
        }
        match told.len().saturating_sub(SHOWN) {
            0 => Ok(()),
            more => write!(f, "\n    and {more} more in summary.json"),
        }
    }
}

impl fmt::Display for Headline {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = |value: &f64| match value.abs() {
            0.0 => "0".into(),
            v if (1e-2..1e5).contains(&v) => {
                let digits = (3 - v.log10().floor() as i32).clamp(0, 5) as usize;
                format!("{value:.digits$}")
            }
            _ => format!("{value:.3e}"),
        };
        let value = match self.value.as_slice() {
            [one] => number(one),
            several => {
                let all: Vec<String> = several.iter().map(number).collect();
                format!("({})", all.join(", "))
            }
        };
        let unit = match self.unit {
            "" => String::new(),
            unit => format!(" {unit}"),
        };
        let off = match self.relative {
            Some(part) if part < 1.0 => percent(part),
            _ => format!("{}{unit}", number(&self.difference)),
        };
        write!(f, "{}: {} {value}{unit} ± {off}", self.table, self.quantity)
    }
}
