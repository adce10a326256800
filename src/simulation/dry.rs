//! Blocks alone: the loop of a scene without fluid.

use super::countable::countable;
use crate::{
    Error, Result,
    coupling::begin,
    rock::{self, Blocks, Snapshot, broadphase::Broadphase},
    scene::{
        Scene,
        build::{BlockSetup, LeftOut, block_setup},
    },
    simulation::checkpoint::BlockCheckpoint,
};

/// Sub-steps of a step where the scene gives no time step: a step keeps its length when contacts
/// stiffen and sub-steps get shorter, and a whole number of them then wastes at most a tenth.
const SUB_STEPS: f64 = 10.0;

/// Blocks of a scene that run.
///
/// Nothing here blocks or needs a device, unless the finder of pairs does.
#[derive(Debug)]
pub struct Dry<F> {
    scene: Scene,
    setup: BlockSetup,
    blocks: Blocks,
    finder: F,
    time_step: f64,
    step: u64,
    /// The blocks at the end of the last whole step.
    good: Snapshot,
}

impl<F: Broadphase> Dry<F> {
    /// The blocks of `scene` at the time 0, pushed apart if it says so; `finder` says which of them
    /// may touch.
    ///
    /// # Errors
    /// What the scene lacks; [`Error::Overlaps`] if blocks overlap, or cannot be pushed apart;
    /// [`Error::TimeStep`] if the step is too long for the contacts at the start.
    pub async fn new(scene: &Scene, finder: F) -> Result<Self> {
        Self::of(scene, block_setup(scene)?, finder).await
    }

    /// The same of the [`block_setup`] of `scene`, for a finder that depends on it.
    ///
    /// # Errors
    /// Those of [`Dry::new`].
    pub async fn of(scene: &Scene, setup: BlockSetup, finder: F) -> Result<Self> {
        let mut finder = finder;
        let blocks = begin(scene, &setup, &mut finder).await?;
        if !blocks.time_step().is_finite() {
            return Err(Error::scene(
                "rock.time_step",
                "no block is free, so that no contact says how long a step may be; give time_step \
                 in s",
            ));
        }
        let usual = SUB_STEPS * blocks.time_step();
        let time_step = match (scene.rock.time_step, scene.run.duration) {
            (Some(given), _) => given,
            (None, None) => usual,
            // A whole number of steps, so that the run ends when it is said to.
            (None, Some(duration)) => duration / (duration / usual).ceil(),
        };
        countable(time_step, &blocks)?;
        Ok(Self {
            scene: scene.clone(),
            time_step,
            setup,
            blocks,
            finder,
            step: 0,
            good: Snapshot::default(),
        })
    }

    /// Takes `steps` steps, each of as many sub-steps as the contacts want.
    ///
    /// # Errors
    /// Those of [`Blocks::step`] and of the finder. The blocks then are where they were after the last
    /// whole step.
    pub async fn advance(&mut self, steps: u64) -> Result<()> {
        for _ in 0..steps {
            let until = (self.step + 1) as f64 * self.time_step;
            // A sub-step that fails leaves the blocks where they were: one alone needs no copy of them.
            let several = self.blocks.steps_to(until) > 1.0;
            if several {
                self.blocks.save(&mut self.good);
            }
            let moved = self.blocks.advance(&mut self.finder, until).await;
            if let Err(error) = moved {
                if several {
                    self.blocks.restore(&self.good)?;
                }
                return Err(error);
            }
            self.step += 1;
        }
        Ok(())
    }

    /// Steps done.
    pub fn step(&self) -> u64 {
        self.step
    }

    /// Length of a step, s.
    pub fn time_step(&self) -> f64 {
        self.time_step
    }

    /// Simulated time, s.
    pub fn time(&self) -> f64 {
        self.step as f64 * self.time_step
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The blocks as they were made: names, shapes, materials.
    pub fn setup(&self) -> &rock::Setup {
        &self.setup.setup
    }

    /// The rock masses of which pieces are missing.
    pub fn left_out(&self) -> &[LeftOut] {
        &self.setup.left_out
    }

    /// The blocks as they are.
    pub fn blocks(&self) -> &Blocks {
        &self.blocks
    }

    /// What finds the pairs that may touch.
    pub fn finder(&self) -> &F {
        &self.finder
    }

    /// The present state, for a later [`Dry::restore`].
    pub fn checkpoint(&self) -> BlockCheckpoint {
        BlockCheckpoint {
            step: self.step,
            time_step: self.time_step,
            snapshot: self.blocks.snapshot(),
        }
    }

    /// Goes on from a checkpoint of the same scene, to the same bits.
    ///
    /// # Errors
    /// If it is of other blocks or another time step.
    pub fn restore(&mut self, checkpoint: &BlockCheckpoint) -> Result<()> {
        if checkpoint.time_step != self.time_step {
            return Err(Error::argument(
                "restart",
                format!(
                    "the checkpoint has a time step of {:e} s, the scene {:e} s; restart with the \
                     scene that wrote it",
                    checkpoint.time_step, self.time_step
                ),
            ));
        }
        self.blocks
            .restore(&checkpoint.snapshot)
            .map_err(|error| Error::argument("restart", error.to_string()))?;
        self.step = checkpoint.step;
        Ok(())
    }
}
