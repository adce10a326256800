//! From the first step to the last, writing what is due on the way.

use super::{
    batch::Batch,
    checkpoints::Checkpoints,
    engine::{Engine, Recorders},
    history::{self, History},
    pace::{Pace, Timed},
    progress::Progress,
    recorder::Notes,
    summary::{Summary, Unfinished},
};
use anyhow::{Context, Result};
use riprap::Error;
use std::{
    path::{Path, PathBuf},
    sync::atomic::{AtomicBool, Ordering},
    time::Instant,
};

/// A run under way.
pub struct Journey<E> {
    folder: PathBuf,
    last: u64,
    recorders: Recorders<E>,
    notes: Notes,
    pace: Pace,
    pub summary: Summary,
}

impl<E: Engine> Journey<E> {
    /// Makes ready what will be written to `folder` until the step `last`; `restart` is the file of
    /// the checkpoint that the simulation has been restored from, `text` what the scene's file holds.
    pub fn new(
        engine: &mut E,
        folder: &Path,
        last: u64,
        restart: Option<&Path>,
        text: &str,
    ) -> Result<Self> {
        let mut recorders: Recorders<E> = Vec::new();
        let scene = engine.scene();
        for probe in &scene.probes {
            if history::claims(&scene.output.histories, &probe.name) {
                return Err(Error::scene(
                    format!("probes.{}", probe.name),
                    "this file belongs to output.histories; give the probe another name",
                )
                .into());
            }
        }
        for number in 0..scene.output.histories.len() {
            recorders.push(Box::new(History::new(engine, folder, last, number)?));
        }
        recorders.extend(engine.recorders(folder, last)?);
        // Last, so that what it continues from has been written.
        recorders.push(Box::new(Checkpoints::new(engine, folder, last, text)));
        let notes = Notes {
            checkpoint: restart.map(|path| (engine.step(), path.to_owned())),
            ..Notes::default()
        };
        Ok(Self {
            folder: folder.to_owned(),
            last,
            recorders,
            notes,
            pace: Pace::default(),
            summary: engine.summary()?,
        })
    }

    /// Computes to the end, or until `stop` is set, or until the flow diverges.
    pub fn go(mut self, engine: &mut E, stop: &AtomicBool) -> Result<Summary> {
        let start = Instant::now();
        let mut progress = Progress::new(engine.step(), self.last);
        let moved = self.travel(engine, stop, &mut progress);
        progress.end();
        let step = engine.step();
        match moved {
            Err(error) => match error.downcast_ref::<Error>() {
                Some(diverged) if leaves_range(diverged) => {
                    self.summary.diverged = true;
                    self.summary.divergence = Some(diverged.to_string());
                    if engine.is_good() {
                        self.record(engine, true)
                            .with_context(|| Unfinished::new(step, &self.notes))?;
                    }
                }
                _ => return Err(error).context(Unfinished::new(step, &self.notes)),
            },
            Ok(()) => self.summary.complete = step == self.last,
        }
        for recorder in &mut self.recorders {
            recorder
                .finish(engine, &mut self.notes)
                .with_context(|| Unfinished::new(step, &self.notes))?;
        }
        engine.conclude(&mut self.summary, &self.notes, &self.pace);
        let summary = &mut self.summary;
        summary.steps = step;
        summary.time = engine.time();
        summary.seconds = start.elapsed().as_secs_f64();
        summary.take(&self.notes);
        summary.tell_left_out();
        let written = summary.write(&self.folder);
        written.with_context(|| Unfinished::new(step, &self.notes))?;
        Ok(self.summary)
    }

    fn travel(&mut self, engine: &mut E, stop: &AtomicBool, progress: &mut Progress) -> Result<()> {
        let mut batch = Batch::new();
        self.record(engine, false)?;
        loop {
            let step = engine.step();
            if step >= self.last {
                return Ok(());
            }
            if stop.load(Ordering::Relaxed) {
                return self.record(engine, true);
            }
            let next = self.recorders.iter().map(|r| r.schedule().next(step)).min();
            let steps = batch.steps().min(next.unwrap_or(self.last) - step);
            let (start, fluid_steps) = (Instant::now(), engine.fluid_steps());
            engine.advance(steps)?;
            let time = start.elapsed();
            batch.learn(steps, time);
            self.pace.add(Timed {
                steps,
                fluid_steps: engine.fluid_steps() - fluid_steps,
                time,
            });
            progress.show(
                step + steps,
                &engine.describe_pace(&self.summary, &self.pace),
            );
            self.record(engine, false)?;
        }
    }

    /// Writes what is due; everything that is not, if the run is `ending` here.
    fn record(&mut self, engine: &mut E, ending: bool) -> Result<()> {
        let step = engine.step();
        for recorder in &mut self.recorders {
            if recorder.schedule().due(step) != ending {
                recorder.record(engine, &mut self.notes)?;
            }
        }
        Ok(())
    }
}

/// Whether a run ends by this because it left the range of the method.
pub fn leaves_range(error: &Error) -> bool {
    matches!(
        error,
        Error::Diverged { .. }
            | Error::ParticleLost { .. }
            | Error::DeepOverlap { .. }
            | Error::NotFinite { .. }
            | Error::Inverted { .. }
    )
}
