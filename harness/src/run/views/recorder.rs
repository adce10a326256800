//! Pictures in space: `NAME_000123.png`, some of them next to each other as `NAME_strip.png`, and all of them as the
//! animation `NAME.png`. A background thread draws each picture in parallel with the simulation.

use super::super::{
    recorder::{Recorder, RunLog, Schedule},
    scene_run::SceneRun,
};
use super::{fluid::Fluid, frame::frame, stage::Stage};
use crate::render::{Drawing, Picture, animate};
use anyhow::{Result, anyhow, bail};
use riprap::scene::View;
use std::{
    path::{Path, PathBuf},
    sync::Arc,
    thread::{self, JoinHandle},
    time::Duration,
};

/// Duration of an animation, unless its frames would then be too short or too long.
const LENGTH: Duration = Duration::from_secs(8);
/// Shortest duration of a frame.
const BRIEFEST: Duration = Duration::from_millis(40);
/// Longest duration of a frame.
const LONGEST: Duration = Duration::from_millis(500);

/// The pictures of a view.
pub struct Views {
    schedule: Schedule,
    view: View,
    fluid: Fluid,
    adapter: Option<String>,
    folder: PathBuf,
    last: u64,
    /// Created with the first picture.
    stage: Option<Arc<Stage>>,
    /// Why it could not be created.
    failed: Option<String>,
    /// The picture that a background thread draws.
    in_progress: Option<(PathBuf, JoinHandle<Result<()>>)>,
    /// Frames for the strip.
    strip: Vec<Drawing<'static>>,
}

impl Views {
    /// The pictures of `view` until the step `last`, drawn on the adapter called `adapter`, or the best one.
    pub fn new(
        run: &SceneRun,
        folder: &Path,
        last: u64,
        view: &View,
        adapter: Option<String>,
    ) -> Self {
        let scene = run.scene();
        let every = view.every.or(scene.output.every);
        Self {
            schedule: Schedule::new(every, run.time_step(), last),
            view: view.clone(),
            fluid: Fluid::new(scene, view),
            adapter,
            folder: folder.to_owned(),
            last,
            stage: None,
            failed: None,
            in_progress: None,
            strip: Vec::new(),
        }
    }

    fn path(&self, ending: &str) -> PathBuf {
        self.folder.join(format!("{}{ending}.png", self.view.name))
    }

    fn stage(&mut self, run: &SceneRun, frame: &Drawing<'static>) -> Result<Arc<Stage>> {
        if let Some(failed) = &self.failed {
            bail!("{failed}");
        }
        if let Some(stage) = &self.stage {
            return Ok(Arc::clone(stage));
        }
        let made = Stage::new(run, &self.view, self.adapter.as_deref(), frame);
        // Do not try again for each picture: it would open a device and fail each time.
        let stage = made.inspect_err(|error| self.failed = Some(format!("{error:#}")))?;
        Ok(Arc::clone(self.stage.insert(Arc::new(stage))))
    }

    /// Draws a frame in the background.
    fn begin(&mut self, run: &SceneRun, frame: Drawing<'static>, path: &Path) -> Result<()> {
        let stage = self.stage(run, &frame)?;
        let file = path.to_owned();
        let draw = move || stage.draw(frame)?.save(&file);
        let thread = thread::Builder::new().name("picture".into()).spawn(draw)?;
        self.in_progress = Some((path.to_owned(), thread));
        Ok(())
    }

    /// Whether the frame at `step` belongs in the strip.
    fn wanted(&self, step: u64) -> bool {
        let count = u64::from(self.view.strip);
        let next = self.strip.len() as u64;
        next < count && step * (count - 1).max(1) >= next * self.last
    }

    /// The pictures in the folder, in the order of their steps, that this run or those that it continues have drawn until
    /// `step`.
    fn frames(&self, step: u64) -> Vec<PathBuf> {
        let mut found = Vec::new();
        let mut at = 0;
        loop {
            let path = self.path(&format!("_{at:06}"));
            if self.schedule.due(at) && path.is_file() {
                found.push(path);
            }
            if at >= step {
                return found;
            }
            at = self.schedule.next(at).min(step);
        }
    }

    fn animate(&self, step: u64, path: &Path) -> Result<()> {
        let frames = self.frames(step);
        let count = frames.len() as u32;
        let delay = (LENGTH / count.max(1)).clamp(BRIEFEST, LONGEST);
        let pictures = frames.iter().map(|frame| Picture::load(frame));
        animate(path, count, delay, pictures)
    }
}

impl Recorder for Views {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, run: &mut SceneRun, log: &mut RunLog) -> Result<()> {
        let path = self.path(&format!("_{:06}", run.step()));
        let frame = frame(run, &self.fluid)?;
        let wanted = self.wanted(run.step()).then(|| frame.clone());
        self.settle(log);
        if let Err(error) = self.begin(run, frame, &path) {
            log.picture(path, Err(error));
        }
        self.strip.extend(wanted);
        Ok(())
    }

    fn settle(&mut self, log: &mut RunLog) {
        if let Some((path, thread)) = self.in_progress.take() {
            let drawn = thread.join();
            let drawn = drawn.unwrap_or_else(|_| Err(anyhow!("the thread that drew it panicked")));
            log.picture(path, drawn);
        }
    }

    fn finish(&mut self, run: &SceneRun, log: &mut RunLog) -> Result<()> {
        self.settle(log);
        let Some(stage) = &self.stage else {
            return Ok(());
        };
        if self.strip.len() > 1 {
            let path = self.path("_strip");
            let drawn = stage.strip(self.strip.clone());
            log.picture(path.clone(), drawn.and_then(|strip| strip.save(&path)));
        }
        let step = run.step();
        if self.view.animation && self.frames(step).len() > 1 {
            let path = self.path("");
            let drawn = self.animate(step, &path);
            log.picture(path, drawn);
        }
        Ok(())
    }
}
