//! The blocks of a scene at the time 0.

use crate::{
    Error, Result,
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

/// The broadphase of the blocks of a scene, on `device` if there is one and the scene permits it.
///
/// # Errors
/// [`Error::Scene`] if the scene wants a device and there is none.
pub(super) fn broadphase(
    device: Option<(&wgpu::Device, &wgpu::Queue)>,
    search: Search,
) -> Result<AutoBroadphase> {
    let mut broadphase = match (device, search) {
        (Some((device, queue)), Search::Auto | Search::Device) => {
            AutoBroadphase::new(device, queue)
        }
        (None, Search::Device) => {
            let message = "pairs are to be searched on a device, and none was given; give one, or use broadphase = \"host\"";
            return Err(Error::scene("rock.broadphase", message));
        }
        (_, Search::Host) | (None, Search::Auto) => AutoBroadphase::on_host(),
    };
    if search == Search::Device {
        broadphase.crossover = 0;
    }
    Ok(broadphase)
}

/// The blocks of a scene at the time 0, pushed apart if it says so. They take a sub-step and go back, so
/// that overlaps and a step that is too long show before the run.
///
/// # Errors
/// [`Error::Overlaps`] if blocks overlap, or cannot be pushed apart; [`Error::TimeStep`] if the step is too long for the
/// contacts at the start.
pub(super) async fn begin(
    scene: &Scene,
    setup: &BlockSetup,
    broadphase: &mut impl Broadphase,
) -> Result<Blocks> {
    let mut blocks = Blocks::new(setup.setup.clone()).map_err(|error| error.at_key(rock_key))?;
    if scene.rock.relax {
        blocks.relax(broadphase, SWEEPS).await?;
    }
    if blocks.time_step().is_finite() {
        let start = blocks.snapshot();
        let pairs = broadphase.pairs(&blocks.aabbs()).await?;
        blocks.set_pairs(pairs)?;
        blocks.step()?;
        blocks.restore(&start)?;
    }
    Ok(blocks)
}
