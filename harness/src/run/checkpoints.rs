//! The state from which a run can go on: `checkpoint.riprap`, and its scene beside it.

use super::{
    origin,
    recorder::{Recorder, RunLog, Schedule},
    scene_run::SceneRun,
};
use anyhow::Result;
use std::path::{Path, PathBuf};

/// Parts of a run after each of which it has a checkpoint, where the scene does not say when.
const PARTS: f64 = 10.0;
/// The same within the first of them: much of what diverges does so soon.
const EARLY: f64 = 100.0;
/// Fewest parts: the last good state should not be the start.
const FEWEST: f64 = 2.0;
/// Bytes that more than these may have together, half a minute of a slow disk: larger states come less often.
const BYTES: f64 = 4e9;

pub struct Checkpoints {
    schedule: Schedule,
    /// The run, where it is ours to choose its parts.
    own: Option<Parted>,
    path: PathBuf,
    /// The scene's file.
    text: String,
}

impl Checkpoints {
    pub fn new(run: &SceneRun, folder: &Path, last: u64, text: &str) -> Self {
        let (asked, time_step) = (run.scene().run.checkpoint_every, run.time_step());
        let parted = Parted { time_step, last };
        Self {
            schedule: match asked {
                Some(every) => Schedule::new(Some(every), time_step, last),
                None => parted.schedule(run.step(), 0),
            },
            own: asked.is_none().then_some(parted),
            path: folder.join("checkpoint.riprap"),
            text: text.to_owned(),
        }
    }
}

/// A run in equal parts.
struct Parted {
    /// s
    time_step: f64,
    last: u64,
}

impl Parted {
    /// When checkpoints of so many bytes are due after `step`.
    fn schedule(&self, step: u64, bytes: u64) -> Schedule {
        let parts = (BYTES / bytes.max(1) as f64).clamp(FEWEST, PARTS).floor();
        let early = parts == PARTS && (step as f64) < self.last as f64 / PARTS;
        let length = self.last as f64 * self.time_step / if early { EARLY } else { parts };
        Schedule::new(Some(length), self.time_step, self.last)
    }
}

impl Recorder for Checkpoints {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, run: &mut SceneRun, log: &mut RunLog) -> Result<()> {
        let step = run.step();
        if step == 0 {
            return Ok(());
        }
        let written = run.checkpoint(&self.path).map_err(Into::into);
        match written.and_then(|()| origin::keep(&self.text, &self.path)) {
            // Nobody asked for it, and the run goes on without.
            Err(error) if self.own.is_some() => {
                const FAILED: &str = "no checkpoint at step";
                // A full disk stays full: one warning is enough.
                if !log.warnings.iter().any(|known| known.starts_with(FAILED)) {
                    log.warnings.push(format!("{FAILED} {step}: {error:#}"));
                }
                return Ok(());
            }
            done => done?,
        }
        log.checkpoint = Some((step, self.path.clone()));
        log.file(self.path.clone());
        if let (Some(run), Ok(file)) = (&self.own, self.path.metadata()) {
            self.schedule = run.schedule(step, file.len());
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The steps at which a run of 200 has checkpoints of so many bytes.
    fn due(bytes: u64) -> Vec<u64> {
        let run = Parted {
            time_step: 0.1,
            last: 200,
        };
        let mut schedule = run.schedule(0, 0);
        let mut due = vec![schedule.next(0)];
        while *due.last().unwrap() < 200 {
            let step = *due.last().unwrap();
            schedule = run.schedule(step, bytes);
            due.push(schedule.next(step));
        }
        due
    }

    #[test]
    fn early_states_are_kept_and_large_ones_are_written_less_often() {
        let tenths = (2..=10).map(|part| 20 * part);
        let small: Vec<u64> = (1..=10).map(|part| 2 * part).chain(tenths).collect();
        assert_eq!(due(400_000_000), small);
        assert_eq!(due(1_000_000_000), [2, 50, 100, 150, 200]);
        assert_eq!(due(1 << 40), [2, 100, 200]);
    }
}
