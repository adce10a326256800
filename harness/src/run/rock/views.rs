//! Pictures of the blocks: `NAME_000123.png`, some of them side by side as `NAME_strip.png`, and all
//! of them in turn as `NAME.png`.

use super::super::{
    engine::Engine,
    recorder::{Notes, Recorder},
    schedule::Schedule,
};
use super::{Rock, stage::Stage};
use crate::render::{Instance, Picture, animate};
use anyhow::{Result, bail};
use riprap::scene::View;
use std::{
    path::{Path, PathBuf},
    time::Duration,
};

/// How long an animation takes, unless its frames would then flicker or stand still.
const LENGTH: Duration = Duration::from_secs(8);
/// Shortest time for a frame.
const BRIEFEST: Duration = Duration::from_millis(40);
/// Longest time for a frame.
const LONGEST: Duration = Duration::from_millis(500);

pub struct Views {
    schedule: Schedule,
    view: View,
    adapter: Option<String>,
    folder: PathBuf,
    last: u64,
    /// Made with the first picture; None once it could not be made.
    stage: Option<Stage>,
    failed: bool,
    /// Frames for the strip: time (s) and bodies.
    strip: Vec<(f64, Vec<Instance>)>,
}

impl Views {
    pub fn new(
        engine: &impl Engine,
        folder: &Path,
        last: u64,
        view: &View,
        adapter: Option<String>,
    ) -> Self {
        let every = view.every.or(engine.scene().output.every);
        Self {
            schedule: Schedule::of(every, engine.time_step(), last),
            view: view.clone(),
            adapter,
            folder: folder.to_owned(),
            last,
            stage: None,
            failed: false,
            strip: Vec::new(),
        }
    }

    fn path(&self, ending: &str) -> PathBuf {
        self.folder.join(format!("{}{ending}.png", self.view.name))
    }

    fn stage(&mut self, engine: &Rock<'_>) -> Result<&Stage> {
        if self.failed {
            bail!("there is no device to draw on");
        }
        if self.stage.is_none() {
            self.failed = true;
            self.stage = Some(Stage::new(engine, &self.view, self.adapter.as_deref())?);
            self.failed = false;
        }
        match &self.stage {
            Some(stage) => Ok(stage),
            None => bail!("there is no device to draw on"),
        }
    }

    fn draw(&mut self, engine: &Rock<'_>, path: &Path) -> Result<()> {
        self.stage(engine)?.draw(engine)?.save(path)
    }

    /// Keeps the present frame if the strip wants one by now.
    fn keep(&mut self, engine: &Rock<'_>) {
        let count = u64::from(self.view.strip);
        let wanted = self.strip.len() as u64;
        if wanted < count && engine.step * (count - 1).max(1) >= wanted * self.last {
            let frame = (engine.time, super::stage::bodies(engine));
            self.strip.push(frame);
        }
    }

    /// The pictures in the folder, in the order of their steps, that this run or those that it goes on
    /// from have made until `step`.
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

impl<E: Engine> Recorder<E> for Views {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, engine: &mut E, notes: &mut Notes) -> Result<()> {
        let Some(rock) = engine.rock() else {
            return Ok(());
        };
        let path = self.path(&format!("_{:06}", rock.step));
        let drawn = self.draw(&rock, &path);
        notes.picture(path, drawn);
        self.keep(&rock);
        Ok(())
    }

    fn finish(&mut self, engine: &E, notes: &mut Notes) -> Result<()> {
        let (Some(stage), Some(rock)) = (&self.stage, engine.rock()) else {
            return Ok(());
        };
        if self.strip.len() > 1 {
            let path = self.path("_strip");
            let drawn = stage.strip(&rock, &self.strip).and_then(|p| p.save(&path));
            notes.picture(path, drawn);
        }
        let step = rock.step;
        if self.view.animation && self.frames(step).len() > 1 {
            let path = self.path("");
            let drawn = self.animate(step, &path);
            notes.picture(path, drawn);
        }
        Ok(())
    }
}
