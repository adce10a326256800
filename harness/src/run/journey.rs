//! From the first step to the last, writing what is due on the way.

use super::{
    batch::Batch,
    checkpoints::Checkpoints,
    engine::Engine,
    fields::Fields,
    history::{self, History},
    probes::ProbeTable,
    progress::{Progress, Speed},
    recorder::{Notes, Recorder},
    slices::Pictures,
    summary::{Summary, Unfinished},
    watch::Watch,
};
use crate::{bench::copy_bandwidth, gpu};
use anyhow::{Context, Result};
use riprap::{
    Error,
    lattice::{bytes_a_cell, bytes_a_step},
};
use std::{
    path::{Path, PathBuf},
    sync::atomic::{AtomicBool, Ordering},
    time::{Duration, Instant},
};

/// Bytes whose copying shows what memory allows: more than caches hold.
const BYTES: u64 = 128 << 20;

/// A run under way.
pub struct Journey {
    folder: PathBuf,
    last: u64,
    recorders: Vec<Box<dyn Recorder>>,
    notes: Notes,
    /// Time spent on steps alone.
    stepping: Duration,
    pub summary: Summary,
}

impl Journey {
    /// Makes ready what will be written to `folder` until the step `last`; `restart` is the file of
    /// the checkpoint that the simulation has been restored from.
    pub fn new(
        engine: &mut Engine,
        folder: &Path,
        last: u64,
        restart: Option<&Path>,
    ) -> Result<Self> {
        let scene = engine.scene().clone();
        let mut recorders: Vec<Box<dyn Recorder>> = vec![Box::new(Watch::new(engine, last))];
        for number in 0..scene.output.histories.len() {
            recorders.push(Box::new(History::new(engine, folder, last, number)?));
        }
        for probe in &scene.probes {
            if history::claims(&scene.output.histories, &probe.name) {
                return Err(Error::scene(
                    format!("probes.{}", probe.name),
                    "this file belongs to output.histories; give the probe another name",
                )
                .into());
            }
            recorders.push(Box::new(ProbeTable::new(engine, folder, last, probe)?));
        }
        recorders.push(Box::new(Fields::new(engine, folder, last)?));
        for slice in &scene.output.slices {
            recorders.push(Box::new(Pictures::new(engine, folder, last, slice)));
        }
        // Last, so that what it continues from has been written.
        recorders.push(Box::new(Checkpoints::new(engine, folder, last)));
        let step = engine.simulation.step();
        let summary = summary(engine, bandwidth(engine)?);
        let notes = Notes {
            checkpoint: restart.map(|path| (step, path.to_owned())),
            ..Notes::default()
        };
        Ok(Self {
            folder: folder.to_owned(),
            last,
            recorders,
            notes,
            stepping: Duration::ZERO,
            summary,
        })
    }

    /// Computes to the end, or until `stop` is set, or until the flow diverges.
    pub fn go(mut self, engine: &mut Engine, stop: &AtomicBool) -> Result<Summary> {
        let start = Instant::now();
        let mut progress = Progress::new(engine.simulation.step(), self.last);
        let moved = self.travel(engine, stop, &mut progress);
        progress.end();
        let step = engine.simulation.step();
        match moved {
            Err(error) => match error.downcast_ref::<Error>() {
                Some(diverged @ Error::Diverged { .. }) => {
                    self.summary.diverged = true;
                    self.summary.divergence = Some(diverged.to_string());
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
        // Others may have kept the device busy the first time.
        if let Ok(again) = bandwidth(engine) {
            self.summary.bandwidth = self.summary.bandwidth.max(again);
        }
        let speed = self.speed(engine);
        let summary = &mut self.summary;
        summary.steps = step;
        summary.time = engine.simulation.time();
        summary.seconds = start.elapsed().as_secs_f64();
        (summary.mlups, summary.bandwidth_share) = (speed.mlups, speed.share);
        summary.max_mach = engine.simulation.units().mach(self.notes.max_speed);
        summary.take(&self.notes);
        let written = summary.write(&self.folder);
        written.with_context(|| Unfinished::new(step, &self.notes))?;
        Ok(self.summary)
    }

    fn travel(
        &mut self,
        engine: &mut Engine,
        stop: &AtomicBool,
        progress: &mut Progress,
    ) -> Result<()> {
        let mut batch = Batch::new();
        self.record(engine, false)?;
        loop {
            let step = engine.simulation.step();
            if step >= self.last {
                return Ok(());
            }
            if stop.load(Ordering::Relaxed) {
                return self.record(engine, true);
            }
            let next = self.recorders.iter().map(|r| r.schedule().next(step)).min();
            let steps = batch.steps().min(next.unwrap_or(self.last) - step);
            let start = Instant::now();
            engine.advance(steps)?;
            let time = start.elapsed();
            batch.learn(steps, time);
            self.stepping += time;
            progress.show(step + steps, &self.speed(engine));
            self.record(engine, false)?;
        }
    }

    /// Writes what is due; everything that is not, if the run is `ending` here.
    fn record(&mut self, engine: &mut Engine, ending: bool) -> Result<()> {
        let step = engine.simulation.step();
        for recorder in &mut self.recorders {
            if recorder.schedule().due(step) != ending {
                recorder.record(engine, &mut self.notes)?;
            }
        }
        Ok(())
    }

    fn speed(&self, engine: &Engine) -> Speed {
        let steps = engine.simulation.step() - self.summary.first_step;
        let rate = steps as f64 / self.stepping.as_secs_f64().max(1e-9);
        Speed {
            mlups: rate * self.summary.fluid_cells as f64 / 1e6,
            share: rate * self.summary.bytes_a_step as f64 / self.summary.bandwidth,
        }
    }
}

/// Bytes a second that the device copies.
fn bandwidth(engine: &Engine) -> Result<f64, Error> {
    copy_bandwidth(&engine.device, &engine.queue, BYTES)
}

/// What is known before the first step.
fn summary(engine: &Engine, bandwidth: f64) -> Summary {
    let simulation = &engine.simulation;
    let (scene, units) = (simulation.scene(), simulation.units());
    let lattice = simulation.lattice();
    let setup = lattice.setup();
    Summary {
        title: scene.title.clone(),
        adapter: gpu::describe(&engine.adapter),
        cells: scene.cells(),
        fluid_cells: lattice.geometry().fluid_cells,
        cell: units.cell,
        time_step: units.time_step,
        tau: setup.tau(),
        kernel: format!(
            "{:?} {:?} {:?} lanes {}{}",
            setup.collision,
            setup.equilibrium,
            setup.storage,
            setup.lanes,
            if setup.wale.is_some() { " Wale" } else { "" }
        ),
        first_step: simulation.step(),
        bandwidth,
        bytes_a_cell: bytes_a_cell(setup),
        bytes_a_step: bytes_a_step(setup, lattice.grid(), lattice.geometry()),
        warnings: simulation
            .advice()
            .iter()
            .map(ToString::to_string)
            .collect(),
        ..Summary::default()
    }
}
