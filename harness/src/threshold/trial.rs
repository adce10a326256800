//! One run of the scene, until a block moves.

use crate::run::{Batch, Engine, Rock};
use anyhow::Result;
use glam::DVec3;
use riprap::{Error, bodies};
use serde::Serialize;
use std::{
    fmt,
    path::{Path, PathBuf},
    sync::atomic::{AtomicBool, Ordering},
    time::Instant,
};

/// Looks at the blocks in a trial: the time of the first motion is known to half a percent of it.
const LOOKS: u64 = 200;
/// Part of a block's size by which it has moved.
const SHARE: f64 = 0.01;

/// What motion is.
#[derive(Clone, Copy, Debug)]
pub enum Criterion {
    /// The centroid is so far from where it was, m; 1 % of the size without a number.
    Distance(Option<f64>),
    /// The centroid is so fast, m/s.
    Speed(f64),
}

/// What a trial is to do.
pub struct Asked<'a> {
    /// The value that it tries.
    pub value: f64,
    /// What motion is.
    pub criterion: Criterion,
    /// The block that counts, or every free one.
    pub block: Option<&'a str>,
    /// Its steps, or those of the scene.
    pub steps: Option<u64>,
    /// The state that it begins with.
    pub settled: Option<PathBuf>,
    /// Set when it is to end.
    pub stop: &'a AtomicBool,
}

/// How a block moves.
#[derive(Clone, Debug, Serialize)]
pub struct Motion {
    /// Its name.
    pub block: String,
    /// Since the trial began, s.
    pub time: f64,
    /// From where it was, m.
    pub distance: f64,
    /// m/s.
    pub speed: f64,
}

/// What came of a trial.
#[derive(Clone, Debug, Serialize)]
pub struct Trial {
    /// The value.
    pub value: f64,
    /// The first motion, if there was one.
    pub moved: Option<Motion>,
    /// The block that came closest to moving, at its end.
    pub closest: Option<Motion>,
    /// Steps that it took.
    pub steps: u64,
    /// Seconds that it took.
    pub seconds: f64,
}

/// Takes `engine` `time` seconds on and writes its state.
pub fn settle<E: Engine>(mut engine: E, time: f64, path: &Path) -> Result<()> {
    let steps = (time / engine.time_step()).round();
    if !(steps.is_finite() && steps >= 1.0) {
        let message = format!(
            "{time} s is no time to settle in; give at least a time step, {:e} s",
            engine.time_step()
        );
        return Err(Error::scene("--settle", message).into());
    }
    let mut batch = Batch::new();
    while engine.step() < steps as u64 {
        let some = batch.steps().min(steps as u64 - engine.step());
        advance(&mut engine, &mut batch, some)?;
    }
    eprintln!("settled in {steps} steps");
    Ok(engine.checkpoint(path)?)
}

fn advance<E: Engine>(engine: &mut E, batch: &mut Batch, steps: u64) -> riprap::Result<()> {
    let start = Instant::now();
    engine.advance(steps)?;
    batch.learn(steps, start.elapsed());
    Ok(())
}

/// Runs a trial; none if it was stopped.
pub fn run<E: Engine>(mut engine: E, asked: &Asked<'_>) -> Result<Option<Trial>> {
    let begun = Instant::now();
    if let Some(path) = &asked.settled {
        engine.restore(path).map_err(|error| match error {
            Error::Scene { place, message } => Error::Scene {
                place,
                message: format!(
                    "{message}; or give numerics.time_step (with blocks alone rock.time_step), so that it \
                     does not depend on the value"
                ),
            },
            other => other,
        })?;
    }
    let watched = Watched::new(&engine, asked)?;
    let first = engine.step();
    let own = engine.scene().run.count(engine.time_step());
    let last = first + asked.steps.unwrap_or(own).max(1);
    let look = ((last - first) / LOOKS).max(1);
    let mut batch = Batch::new();
    let (mut moved, mut closest) = (None, None);
    while moved.is_none() && engine.step() < last {
        if asked.stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let at = engine.step() - first;
        let next = first + (at / look + 1) * look;
        let steps = batch.steps().min(next.min(last) - engine.step());
        advance(&mut engine, &mut batch, steps)?;
        (closest, moved) = watched.look(&engine, asked.criterion);
    }
    Ok(Some(Trial {
        value: asked.value,
        moved,
        closest,
        steps: engine.step() - first,
        seconds: begun.elapsed().as_secs_f64(),
    }))
}

/// The blocks whose motion counts.
struct Watched {
    /// Number, place at the start (m), and size (m).
    blocks: Vec<(usize, DVec3, f64)>,
    /// When the trial began, s.
    start: f64,
}

impl Watched {
    fn new(engine: &impl Engine, asked: &Asked<'_>) -> riprap::Result<Self> {
        let Some(rock) = engine.rock() else {
            let message = "it has no blocks; add [[blocks]] or [[rock_masses]]";
            return Err(Error::scene("scene", message));
        };
        let free = |block: &bodies::Block| block.motion == bodies::Motion::Free;
        let counts = |block: &bodies::Block| match asked.block {
            Some(name) => block.name == name && free(block),
            None => free(block),
        };
        let poses = rock.blocks.poses();
        let blocks: Vec<_> = rock.setup.blocks.iter().enumerate().collect();
        let watched: Vec<_> = blocks
            .iter()
            .filter(|(_, block)| counts(block))
            .map(|(n, block)| (*n, poses[*n].centre, block.shape.volume().cbrt()))
            .collect();
        if watched.is_empty() {
            let names = blocks.iter().filter(|(_, block)| free(block));
            let names: Vec<_> = names.take(20).map(|(_, block)| &*block.name).collect();
            let message = format!("no free block is called so; there are {}", names.join(", "));
            return Err(Error::scene("--block", message));
        }
        Ok(Self {
            blocks: watched,
            start: engine.time(),
        })
    }

    /// The block that is closest to moving, and the same once it has moved.
    fn look(&self, engine: &impl Engine, criterion: Criterion) -> (Option<Motion>, Option<Motion>) {
        let Some(rock) = engine.rock() else {
            return (None, None);
        };
        let poses = rock.blocks.poses();
        let part = |(block, place, size): &(usize, DVec3, f64)| {
            let pose = &poses[*block];
            match criterion {
                Criterion::Distance(limit) => {
                    (pose.centre - *place).length() / limit.unwrap_or(SHARE * size)
                }
                Criterion::Speed(limit) => pose.velocity.length() / limit,
            }
        };
        let parts = self.blocks.iter().map(|block| (block, part(block)));
        let Some((block, part)) = parts.max_by(|a, b| a.1.total_cmp(&b.1)) else {
            return (None, None);
        };
        let motion = motion(&rock, block, rock.time - self.start);
        let moved = (part >= 1.0).then(|| motion.clone());
        (Some(motion), moved)
    }
}

fn motion(rock: &Rock<'_>, (block, place, _): &(usize, DVec3, f64), time: f64) -> Motion {
    let pose = rock.blocks.poses()[*block];
    Motion {
        block: rock.blocks.name(*block).into(),
        time,
        distance: (pose.centre - *place).length(),
        speed: pose.velocity.length(),
    }
}

impl fmt::Display for Trial {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let told = self.moved.as_ref().or(self.closest.as_ref());
        match (told, &self.moved) {
            (Some(motion), Some(_)) => write!(
                f,
                "{}: {} moves after {:.4e} s, {:.2e} m away at {:.2e} m/s",
                self.value, motion.block, motion.time, motion.distance, motion.speed
            ),
            (Some(motion), None) => write!(
                f,
                "{}: still after {:.4e} s; {} is {:.2e} m away at {:.2e} m/s",
                self.value, motion.time, motion.block, motion.distance, motion.speed
            ),
            (None, _) => write!(f, "{}: still", self.value),
        }?;
        write!(f, " ({} steps, {:.1} s)", self.steps, self.seconds)
    }
}
