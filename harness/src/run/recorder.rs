//! What a run writes, one thing a type.

use super::{rock::Safety, scene_run::SceneRun, schedule::Schedule};
use anyhow::Result;
use std::path::PathBuf;

/// The recorders of a run.
pub type Recorders = Vec<Box<dyn Recorder>>;

/// Writes something about the present state when it is due.
pub trait Recorder {
    /// When it is due.
    fn schedule(&self) -> &Schedule;

    /// Writes, and says which files.
    fn record(&mut self, run: &mut SceneRun, log: &mut RunLog) -> Result<()>;

    /// Writes what only the end of the run can show.
    fn finish(&mut self, _run: &SceneRun, _log: &mut RunLog) -> Result<()> {
        Ok(())
    }
}

/// Files, warnings and extremes of a run, which recorders note.
#[derive(Clone, Debug, Default)]
pub struct RunLog {
    /// Files written, each once.
    pub files: Vec<PathBuf>,
    /// What did not work and does not end the run.
    pub warnings: Vec<String>,
    /// The last checkpoint with its step.
    pub checkpoint: Option<(u64, PathBuf)>,
    /// Largest speed of the fluid that was seen, m/s.
    pub max_speed: f64,
    /// Largest speed of a block's centroid that was seen, m/s.
    pub block_speed: f64,
    /// How safely blocks stand whose probes ask.
    pub safety: Vec<Safety>,
}

impl RunLog {
    /// A file has been written.
    pub fn file(&mut self, path: PathBuf) {
        if !self.files.contains(&path) {
            self.files.push(path);
        }
    }

    /// A picture has been drawn, or not: that is no reason to end a run.
    pub fn picture(&mut self, path: PathBuf, drawn: Result<()>) {
        match drawn {
            Ok(()) => self.file(path),
            Err(error) => {
                let warning = format!("{} is not drawn: {error:#}", path.display());
                if !self.warnings.contains(&warning) {
                    self.warnings.push(warning);
                }
            }
        }
    }
}
