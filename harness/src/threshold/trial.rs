//! One run of the scene, until a block moves.

use super::{Args, Equilibrium, Key, equilibrium::Loads};
use crate::run::{Batch, SceneRun};
use anyhow::Result;
use glam::DVec3;
use riprap::{Error, rock};
use serde::Serialize;
use std::{
    fmt,
    path::Path,
    sync::atomic::{AtomicBool, Ordering},
    time::Instant,
};

/// Samples of the blocks in a trial: the time of the first motion is known to half a percent of its duration.
const LOOKS: u64 = 200;
/// Displacement over the size of a block that counts as motion.
const SHARE: f64 = 0.01;
/// Fraction of that displacement from which a block that still moves is under way: contacts that take up their load move it by
/// less.
pub(super) const BEGUN: f64 = 0.1;

/// Sections of a scene that hold for its start alone.
const STARTS: [&str; 2] = ["initial", "water"];

/// Criterion for motion.
#[derive(Clone, Copy, Debug)]
enum Criterion {
    /// Displacement of the centroid, m; 1 % of the size if `None`.
    Distance(Option<f64>),
    /// Speed of the centroid, m/s.
    Speed(f64),
}

impl Criterion {
    fn of(args: &Args) -> Self {
        match args.speed {
            Some(speed) => Self::Speed(speed),
            None => Self::Distance(args.distance),
        }
    }
}

/// Motion of a block.
#[derive(Clone, Debug, Serialize)]
pub struct Motion {
    /// Its name.
    pub block: String,
    /// Time since the trial began, s.
    pub time: f64,
    /// Displacement since the trial began, m.
    pub distance: f64,
    /// Speed, m/s.
    pub speed: f64,
    /// That distance or speed over the criterion.
    pub part: f64,
}

impl Motion {
    /// Whether the block would move within another such trial, at this speed or with this mean acceleration.
    fn goes_on(&self, criterion: Criterion) -> bool {
        match criterion {
            Criterion::Distance(_) => {
                let rest = self.distance * (1.0 / self.part - 1.0);
                self.part > BEGUN && self.speed * self.time >= rest
            }
            Criterion::Speed(_) => self.part >= 0.5,
        }
    }
}

/// Result of a trial.
#[derive(Clone, Debug, Serialize)]
pub struct Trial {
    /// The value.
    pub value: f64,
    /// The first motion, if there was one.
    pub moved: Option<Motion>,
    /// The block closest to moving at the end.
    pub closest: Option<Motion>,
    /// With `--equilibrium`: the limit equilibrium under its mean loads, if no block moved.
    pub equilibrium: Option<Equilibrium>,
    /// Whether no block had moved at the end, but one would have in another such trial.
    pub under_way: bool,
    /// Number of steps.
    pub steps: u64,
    /// Duration, s.
    pub seconds: f64,
}

/// Refuses `keys` that change where the blocks, or the fluid alone, start: between the runs `from` and `to`. The settled state would
/// replace that.
pub fn check_settled(from: &SceneRun, to: &SceneRun, keys: &[Key]) -> Result<()> {
    let starts = |run: &SceneRun| -> Vec<_> {
        let blocks = run.rock().map(|rock| rock.setup.blocks.iter());
        let start = |block: &rock::Block| {
            let place = (block.centre, block.rotation);
            let motion = (block.velocity, block.spin);
            (block.name.clone(), block.shape.clone(), place, motion)
        };
        blocks.into_iter().flatten().map(start).collect()
    };
    let (before, after) = (starts(from), starts(to));
    let mut pairs = before.iter().zip(&after);
    let what = match pairs.find(|(before, after)| before != after) {
        Some(((name, ..), _)) => format!("shape, position or velocity of block `{name}`"),
        None if before.len() != after.len() => "the number of blocks".into(),
        None if keys.iter().all(|key| STARTS.contains(&key.section())) => "the fluid".into(),
        None => return Ok(()),
    };
    let message = format!(
        "the key changes {what} at the start of the scene, and each trial begins with the settled state instead; leave \
         --settle out"
    );
    Err(Error::argument("--settle", message).into())
}

/// Runs `run` for `time` seconds and writes its state.
pub fn settle(mut run: SceneRun, time: f64, path: &Path) -> Result<()> {
    let steps = (time / run.time_step()).round();
    if !(steps.is_finite() && steps >= 1.0) {
        let message = format!(
            "{time} s is no time to settle in; give at least a time step, {:e} s",
            run.time_step()
        );
        return Err(Error::argument("--settle", message).into());
    }
    let mut batch = Batch::new();
    while run.step() < steps as u64 {
        let some = batch.steps().min(steps as u64 - run.step());
        advance(&mut run, &mut batch, some)?;
    }
    eprintln!("settled in {steps} steps");
    Ok(run.checkpoint(path)?)
}

fn advance(run: &mut SceneRun, batch: &mut Batch, steps: u64) -> riprap::Result<()> {
    let start = Instant::now();
    run.advance(steps)?;
    batch.learn(steps, start.elapsed());
    Ok(())
}

/// Runs a trial of `value`, from the state in the file `settled` if there is one; `None` if it was stopped.
pub fn run(
    mut run: SceneRun,
    value: f64,
    args: &Args,
    settled: Option<&Path>,
    stop: &AtomicBool,
) -> Result<Option<Trial>> {
    let begun = Instant::now();
    let criterion = Criterion::of(args);
    if let Some(path) = settled {
        run.restore(path).map_err(|error| match error {
            Error::Argument { what, message } => Error::Argument {
                what,
                message: format!(
                    "{message}; or give numerics.time_step (with blocks alone rock.time_step), so that it \
                     does not depend on the value"
                ),
            },
            other => other,
        })?;
    }
    let watched = Watched::new(&run, args.block.as_deref())?;
    let mut loads = match args.equilibrium {
        true => Some(watched.loads(&run)?),
        false => None,
    };
    let first = run.step();
    let own = run.scene().run.count(run.time_step());
    let last = first + args.steps.unwrap_or(own).max(1);
    let look = ((last - first) / LOOKS).max(1);
    let mut batch = Batch::new();
    let (mut moved, mut closest) = (None, None);
    while moved.is_none() && run.step() < last {
        if stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let at = run.step() - first;
        let next = first + (at / look + 1) * look;
        let steps = batch.steps().min(next.min(last) - run.step());
        advance(&mut run, &mut batch, steps)?;
        (closest, moved) = watched.look(&run, criterion);
        if let Some(loads) = &mut loads {
            loads.look(&run);
        }
    }
    let still = loads.filter(|_| moved.is_none());
    let goes_on = |motion: &Motion| motion.goes_on(criterion);
    Ok(Some(Trial {
        value,
        equilibrium: still.and_then(|loads| loads.equilibrium(value)),
        under_way: moved.is_none() && closest.as_ref().is_some_and(goes_on),
        moved,
        closest,
        steps: run.step() - first,
        seconds: begun.elapsed().as_secs_f64(),
    }))
}

/// The blocks whose motion counts.
struct Watched {
    /// Number, initial position (m), and size (m).
    blocks: Vec<(usize, DVec3, f64)>,
    /// Time at the start of the trial, s.
    start: f64,
}

impl Watched {
    fn new(run: &SceneRun, wanted: Option<&str>) -> riprap::Result<Self> {
        let Some(rock) = run.rock() else {
            let message = "it has no blocks; add [[blocks]] or [[rock_masses]]";
            return Err(Error::scene("scene", message));
        };
        let free = |block: &rock::Block| block.motion == rock::Motion::Free;
        let counts =
            |block: &rock::Block| free(block) && wanted.is_none_or(|name| block.name == name);
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
            let message = format!(
                "no free block has this name; there are {}",
                names.join(", ")
            );
            return Err(Error::argument("--block", message));
        }
        Ok(Self {
            blocks: watched,
            start: run.time(),
        })
    }

    /// Loads to be sampled on all watched blocks.
    fn loads(&self, run: &SceneRun) -> riprap::Result<Loads> {
        let watched = self.blocks.iter().map(|(n, ..)| *n);
        match run.rock() {
            Some(rock) if !rock.loads.is_empty() => {
                Ok(Loads::new(watched, &rock, run.scene().fluid.density))
            }
            _ => {
                let message = "no fluid flows around the blocks; leave it out";
                Err(Error::argument("--equilibrium", message))
            }
        }
    }

    /// The block that is closest to moving, and the same once it has moved.
    fn look(&self, run: &SceneRun, criterion: Criterion) -> (Option<Motion>, Option<Motion>) {
        let Some(rock) = run.rock() else {
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
        let Some(((block, place, _), part)) = parts.max_by(|a, b| a.1.total_cmp(&b.1)) else {
            return (None, None);
        };
        let motion = Motion {
            block: rock.blocks.name(*block).into(),
            time: rock.time - self.start,
            distance: (poses[*block].centre - *place).length(),
            speed: poses[*block].velocity.length(),
            part,
        };
        let moved = (part >= 1.0).then(|| motion.clone());
        (Some(motion), moved)
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
                "{}: {} after {:.4e} s; {} is {:.2e} m away at {:.2e} m/s",
                self.value,
                if self.under_way {
                    "still, but under way,"
                } else {
                    "still"
                },
                motion.time,
                motion.block,
                motion.distance,
                motion.speed
            ),
            (None, _) => write!(f, "{}: still", self.value),
        }?;
        write!(f, " ({} steps, {:.1} s)", self.steps, self.seconds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_another_trial_would_see_move_is_under_way() {
        // 80 µm count as motion, a trial is 15 s.
        let goes_on = |distance: f64, speed| {
            let motion = Motion {
                block: "s".into(),
                time: 15.0,
                distance,
                speed,
                part: distance / 8e-5,
            };
            motion.goes_on(Criterion::Distance(None))
        };
        assert!(goes_on(7.86e-5, 6.21e-6) && goes_on(3.69e-5, 9.84e-6));
        // It has settled by less than a tenth, or comes to rest.
        assert!(!goes_on(5.48e-8, 3.4e-10) && !goes_on(7e-6, 1e-5) && !goes_on(5e-5, 1e-6));
    }
}
