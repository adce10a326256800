//! The summary of a run, for people and for programs: `summary.json`.

use super::{
    estimate::Estimate,
    lattice::{Coupling, LatticeSummary},
    progress::clock,
    recorder::RunLog,
    rock::{Rocks, Safety},
    skipped_work::SkippedWork,
    statistics::Converged,
    walls::WallModelSummary,
    water::{Energies, WaterSummary},
};
use crate::print;
use riprap::output::replace;
use serde::Serialize;
use std::{
    fmt,
    path::{Path, PathBuf},
};

/// Summary of a run.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Summary {
    /// The scene file.
    pub scene: String,
    /// The scene's title.
    pub title: String,
    /// Adapter, interface and driver.
    pub adapter: String,
    /// The lattice, if there is one.
    #[serde(flatten)]
    pub lattice: Option<LatticeSummary>,
    /// Time step, s.
    pub time_step: f64,
    /// Step at which this run began: 0, or that of the checkpoint.
    pub first_step: u64,
    /// Steps done, those before a restart included.
    pub steps: u64,
    /// Simulated time, s.
    pub time: f64,
    /// Whether the run reached its end.
    pub complete: bool,
    /// Seconds that this run took, output included.
    pub seconds: f64,
    /// Whether the flow left the range of the method.
    pub diverged: bool,
    /// Why and where it diverged, and what to change.
    pub divergence: Option<String>,
    /// Warnings about the scene and its results.
    pub warnings: Vec<String>,
    /// Files written.
    pub files: Vec<PathBuf>,
    /// The last checkpoint of this run, or the one that it began with.
    pub checkpoint: Option<PathBuf>,
    /// Its step.
    pub checkpoint_step: Option<u64>,
    /// Largest y⁺ half a cell from a wall or solid without a wall model at the end, if there is one: see
    /// [`riprap::simulation::WallUnits`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y_plus_walls: Option<f64>,
    /// Largest y⁺ half a cell from a block at the end, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y_plus_blocks: Option<f64>,
    /// The wall model, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wall_model: Option<WallModelSummary>,
    /// The coupling, if there are blocks in a fluid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coupling: Option<Coupling>,
    /// The particles of water, if there are some.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pool: Option<WaterSummary>,
    /// Energy balance of the particles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub water_energies: Option<Energies>,
    /// The blocks, if there are some.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rocks: Option<Rocks>,
    /// Work that was skipped because nothing needed it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<SkippedWork>,
    /// Factors of safety of the blocks whose probes request them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub safety: Vec<Safety>,
    /// Statistical errors of the means, in a run with `--until-error`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub statistics: Option<Converged>,
    /// Differences of headline numbers from those at half the resolution, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_estimate: Option<Estimate>,
}

impl Summary {
    /// Takes over the notes of the recorders.
    pub fn take(&mut self, log: &RunLog) {
        self.files.clone_from(&log.files);
        self.safety.clone_from(&log.safety);
        self.warnings.extend(log.warnings.iter().cloned());
        if let Some((step, path)) = &log.checkpoint {
            self.checkpoint = Some(path.clone());
            self.checkpoint_step = Some(*step);
        }
    }

    /// Adds the work that blocks and particles skipped to that of the fluid.
    pub fn tell_left_out(&mut self) {
        let (coupling, rocks, pool) = (&self.coupling, &self.rocks, &self.pool);
        self.left_out
            .extend(coupling.iter().flat_map(SkippedWork::of_coupling));
        self.left_out
            .extend(rocks.iter().flat_map(SkippedWork::of_rocks));
        self.left_out
            .extend(pool.iter().flat_map(SkippedWork::of_pool));
    }

    /// Writes `summary.json` into `folder` and lists it among the files.
    pub fn write(&mut self, folder: &Path) -> anyhow::Result<()> {
        let path = folder.join("summary.json");
        if !self.files.contains(&path) {
            self.files.push(path.clone());
        }
        let text = serde_json::to_string_pretty(self)? + "\n";
        replace(&path, |file| file.write_all(text.as_bytes()))?;
        Ok(())
    }

    /// The files on disk, in one sentence.
    pub fn kept(&self) -> String {
        kept(
            self.checkpoint.as_deref(),
            self.checkpoint_step,
            self.files.len(),
        )
    }
}

fn kept(checkpoint: Option<&Path>, step: Option<u64>, files: usize) -> String {
    match (checkpoint, step) {
        (Some(path), Some(step)) => format!(
            "{files} files are kept; `--restart {}` goes on from step {step}",
            path.display()
        ),
        _ => format!(
            "{files} files are kept, and no checkpoint: run.checkpoint_every gives earlier ones, if the disk has room"
        ),
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let end = match (self.diverged, self.complete) {
            (true, _) => "diverged",
            (false, true) => "done",
            (false, false) => "stopped",
        };
        writeln!(
            f,
            "{end} at step {}, t = {}, after {}",
            self.steps,
            print::time(self.time, 6),
            clock(self.seconds)
        )?;
        if let Some(lattice) = &self.lattice {
            writeln!(f, "{lattice}")?;
        }
        let walls = match self.wall_model {
            Some(_) => "walls without the wall model",
            None => "walls",
        };
        for (what, y_plus) in [(walls, self.y_plus_walls), ("blocks", self.y_plus_blocks)] {
            if let Some(y_plus) = y_plus {
                writeln!(f, "  largest y⁺ half a cell from {what}: {y_plus:.2}")?;
            }
        }
        if let Some(walls) = &self.wall_model {
            writeln!(f, "{walls}")?;
        }
        if let Some(pool) = &self.pool {
            writeln!(f, "{pool}")?;
        }
        if let Some(energies) = &self.water_energies {
            writeln!(f, "{energies}")?;
        }
        if let Some(coupling) = &self.coupling {
            writeln!(f, "{coupling}")?;
        }
        if let Some(rocks) = &self.rocks {
            writeln!(f, "{rocks}")?;
        }
        if let Some(statistics) = &self.statistics {
            writeln!(f, "{statistics}")?;
        }
        for safety in &self.safety {
            writeln!(f, "  {safety}")?;
        }
        if let Some(line) = SkippedWork::line(&self.left_out) {
            writeln!(f, "  ran {line}")?;
        }
        for warning in &self.warnings {
            writeln!(f, "  warning: {warning}")?;
        }
        if let Some(estimate) = &self.error_estimate {
            writeln!(f, "{estimate}")?;
        }
        if let Some(divergence) = &self.divergence {
            writeln!(f, "  {divergence}")?;
        }
        write!(f, "  {}", self.kept())
    }
}

/// Context of the error of a run that something other than the flow ended: the disk, the device.
#[derive(Clone, Debug)]
pub struct Unfinished {
    /// Steps done.
    pub step: u64,
    /// Files on disk, in one sentence.
    pub kept: String,
}

impl Unfinished {
    pub(super) fn new(step: u64, log: &RunLog) -> Self {
        let (at, path) = log.checkpoint.clone().unzip();
        Self {
            step,
            kept: kept(path.as_deref(), at, log.files.len()),
        }
    }
}

impl fmt::Display for Unfinished {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the run ended at step {} ({})", self.step, self.kept)
    }
}
