//! The blocks of a scene at the time 0.

use crate::{
    Result,
    rock::{
        Blocks,
        broadphase::{AutoBroadphase, Broadphase},
    },
    scene::{
        Scene, Search,
        build::{BlockSetup, rock_key},
    },
};

/// Sweeps over all pairs in which blocks that overlap are pushed apart; each sweep settles a layer of
/// a pile, so this is enough for any that a scene lays by hand.
const SWEEPS: usize = 1000;

/// What finds the pairs of a scene's blocks beside a fluid, whose device it may use.
pub(crate) fn finder(device: &wgpu::Device, queue: &wgpu::Queue, search: Search) -> AutoBroadphase {
    let mut finder = AutoBroadphase::new(device, queue);
    match search {
        Search::Auto => {}
        Search::Host => finder.crossover = usize::MAX,
        Search::Device => finder.crossover = 0,
    }
    finder
}

/// The blocks of a scene at the time 0, pushed apart if it says so. They take a sub-step and go back, so
/// that overlaps and a step that is too long show before the run.
///
/// # Errors
/// Those of [`Blocks::new`], [`Blocks::relax`] and [`Blocks::step`].
pub(crate) async fn begin(
    scene: &Scene,
    setup: &BlockSetup,
    finder: &mut impl Broadphase,
) -> Result<Blocks> {
    let mut blocks = Blocks::new(setup.setup.clone()).map_err(|error| error.at_key(rock_key))?;
    if scene.rock.relax {
        blocks.relax(finder, SWEEPS).await?;
    }
    if blocks.time_step().is_finite() {
        let start = blocks.snapshot();
        let pairs = finder.pairs(&blocks.aabbs()).await?;
        blocks.set_pairs(pairs)?;
        blocks.step()?;
        blocks.restore(&start)?;
    }
    Ok(blocks)
}
