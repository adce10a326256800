//! Advances a run from the first step to the last and writes what is due.

use super::{
    checkpoints::Checkpoints,
    extremes,
    header::print_header,
    history,
    progress::Progress,
    recorder::{Recorders, RunLog},
    scene_run::SceneRun,
    statistics::{Convergence, TableStatistics, UntilError},
    summary::{Summary, Unfinished},
    throughput::{Batch, Throughput, Timed},
};
use anyhow::{Context, Result};
use riprap::{Error, scene::Scene};
use std::{
    path::{Path, PathBuf},
    sync::atomic::{AtomicBool, Ordering},
    time::Instant,
};

/// A run under way.
pub struct Runner {
    folder: PathBuf,
    last: u64,
    recorders: Recorders,
    log: RunLog,
    throughput: Throughput,
    /// Criterion that may end the run before its last step.
    convergence: Option<Convergence>,
    pub summary: Summary,
}

impl Runner {
    /// Prepares the output to `folder` until the step `last`; `restart` is the file of the checkpoint from which the
    /// simulation has been restored, `text` the content of the scene file.
    pub fn new(
        run: &mut SceneRun,
        folder: &Path,
        last: u64,
        restart: Option<&Path>,
        text: &str,
    ) -> Result<Self> {
        let mut recorders: Recorders = Vec::new();
        let scene = run.scene();
        for number in 0..scene.output.histories.len() {
            recorders.push(history::recorder(run, folder, last, number)?);
        }
        recorders.extend(run.recorders(folder, last)?);
        // Last, so that the files that a restart continues have been written.
        recorders.push(Box::new(Checkpoints::new(run, folder, last, text)));
        let mut log = RunLog::default();
        if let Some(path) = restart {
            log.checkpoint = Some((run.step(), path.to_owned()));
            extremes::resume(path, run.step(), &mut log);
        }
        Ok(Self {
            folder: folder.to_owned(),
            last,
            recorders,
            log,
            throughput: Throughput::default(),
            convergence: None,
            summary: run.summary()?,
        })
    }

    /// Makes the run stop when the statistical errors of the quantities `of`, or of all probes of `scene`, are at most `until`.
    pub fn stop_at_error(&mut self, until: UntilError, of: &[String], scene: &Scene) -> Result<()> {
        let probes: Vec<&str> = scene
            .probes
            .iter()
            .map(|probe| probe.name.as_str())
            .collect();
        let convergence = Convergence::new(until, of, &probes, &self.statistics())?;
        self.convergence = Some(convergence);
        Ok(())
    }

    fn statistics(&self) -> Vec<&TableStatistics> {
        let recorders = self.recorders.iter();
        recorders
            .filter_map(|recorder| recorder.statistics())
            .collect()
    }

    /// Whether the statistical errors are small enough.
    fn has_converged(&mut self) -> bool {
        let convergence = self.convergence.as_ref();
        let now = convergence.map(|convergence| convergence.now(&self.statistics()));
        self.summary.statistics = now;
        self.summary
            .statistics
            .as_ref()
            .is_some_and(|now| now.reached)
    }

    /// Prints scene, adapter and steps to standard error.
    pub fn print_header(&self, run: &SceneRun) {
        print_header(run, &self.summary, &self.folder, self.last);
    }

    /// Runs to the end, until `stop` is set, or until the flow diverges.
    pub fn run_to_end(mut self, run: &mut SceneRun, stop: &AtomicBool) -> Result<Summary> {
        let start = Instant::now();
        let mut progress = Progress::new(run.step(), self.last);
        let moved = self.advance_to_last(run, stop, &mut progress);
        progress.end();
        let step = run.step();
        match moved {
            Err(error) => match error.downcast_ref::<Error>() {
                Some(diverged) if leaves_range(diverged) => {
                    self.summary.diverged = true;
                    self.summary.divergence = Some(diverged.to_string());
                    if run.is_intact() {
                        self.record(run, true)
                            .with_context(|| self.unfinished(step))?;
                    }
                }
                _ => return Err(error).context(self.unfinished(step)),
            },
            Ok(()) => self.summary.complete = step == self.last || self.has_converged(),
        }
        let mut recorders = self.recorders.iter_mut();
        let finished = recorders.try_for_each(|recorder| recorder.finish(run, &mut self.log));
        finished.with_context(|| self.unfinished(step))?;
        run.finish(&mut self.summary, &self.log, &self.throughput);
        let summary = &mut self.summary;
        summary.steps = step;
        summary.time = run.time();
        summary.seconds = start.elapsed().as_secs_f64();
        summary.take(&self.log);
        summary.tell_left_out();
        let written = summary.write(&self.folder);
        written.with_context(|| Unfinished::new(step, &self.log))?;
        Ok(self.summary)
    }

    fn advance_to_last(
        &mut self,
        run: &mut SceneRun,
        stop: &AtomicBool,
        progress: &mut Progress,
    ) -> Result<()> {
        let mut batch = Batch::new();
        self.record(run, false)?;
        loop {
            let step = run.step();
            if step >= self.last {
                return Ok(());
            }
            if stop.load(Ordering::Relaxed) || self.has_converged() {
                return self.record(run, true);
            }
            let next = self.recorders.iter().map(|r| r.schedule().next(step)).min();
            let steps = batch.steps().min(next.unwrap_or(self.last) - step);
            let (start, fluid_steps) = (Instant::now(), run.simulation.fluid_steps());
            run.advance(steps)?;
            let time = start.elapsed();
            batch.learn(steps, time);
            self.throughput.add(Timed {
                steps,
                fluid_steps: run.simulation.fluid_steps() - fluid_steps,
                time,
            });
            progress.show(step + steps, &run.describe(&self.summary, &self.throughput));
            self.record(run, false)?;
        }
    }

    /// Writes what is due; if the run is `ending` here, also what is not due.
    fn record(&mut self, run: &mut SceneRun, ending: bool) -> Result<()> {
        let step = run.step();
        for number in 0..self.recorders.len() {
            if self.recorders[number].schedule().due(step) == ending {
                continue;
            }
            // The last recorder writes checkpoints.
            if number + 1 == self.recorders.len() {
                self.settle();
            }
            self.recorders[number].record(run, &mut self.log)?;
        }
        Ok(())
    }

    /// Waits for all output that is still being written.
    fn settle(&mut self) {
        let recorders = self.recorders.iter_mut();
        recorders.for_each(|recorder| recorder.settle(&mut self.log));
    }

    /// The error context of a run that ends by an error at `step`, with the files that are kept.
    fn unfinished(&mut self, step: u64) -> Unfinished {
        self.settle();
        Unfinished::new(step, &self.log)
    }
}

/// Whether `error` ends a run because it left the range of the method.
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
