//! The adapter for the broadphase of scenes without a fluid, and the line of an error in a scene file.

use crate::gpu;
use riprap::{
    Error, Result,
    gpu::Processor,
    rock::broadphase::AutoBroadphase,
    scene::{
        BroadphaseBackend, Scene,
        build::{BlockSetup, DiscardedPieces},
    },
    wgpu,
};
use std::path::Path;

/// The adapter for the broadphase of `scene`: the one called `name`, or the best one. `None` if the broadphase runs on
/// the host.
pub fn adapter(
    scene: &Scene,
    blocks: &BlockSetup,
    name: Option<&str>,
) -> Result<Option<wgpu::Adapter>> {
    let blocks = blocks.setup.blocks.iter();
    let parts: usize = blocks.map(|block| block.shape.parts().len()).sum();
    match scene.rock.broadphase {
        BroadphaseBackend::Device => gpu::pick(name).map(Some),
        BroadphaseBackend::Host => Ok(None),
        BroadphaseBackend::Auto => {
            // Adapters are only enumerated if one could be used.
            let from = |processor| {
                let given = scene.rock.broadphase_crossover;
                parts >= given.unwrap_or(AutoBroadphase::crossover_on(processor))
            };
            if !from(Processor::Gpu) {
                return Ok(None);
            }
            let processor = |found: &wgpu::Adapter| scene.run.kernels.processor(&found.get_info());
            let found = gpu::pick(name).ok();
            Ok(found.filter(|found| from(processor(found))))
        }
    }
}

/// The error of a scene that was read from `file`, with its line there.
pub fn located(error: Error, file: &Path) -> Error {
    match std::fs::read_to_string(file) {
        Ok(text) => Scene::locate(error, &text, &file.display().to_string()),
        Err(_) => error,
    }
}

/// The pieces left out of rock masses, one line per mass.
pub fn left_out(all: &[DiscardedPieces]) -> impl Iterator<Item = String> {
    let line = |lost: &DiscardedPieces| {
        format!(
            "{} pieces of {}, {:.1} % of it: smaller or thinner than its smallest_volume and \
             smallest_thickness{}",
            lost.pieces,
            lost.mass,
            100.0 * lost.share,
            match lost.narrow {
                0 => String::new(),
                narrow => format!(", {narrow} of them narrower than its aperture"),
            }
        )
    };
    all.iter().map(line)
}
