//! What a run of blocks says before it starts.

use super::{Dry, Engine};
use crate::search::left_out;
use riprap::bodies::Motion;
use std::path::Path;

/// Tells, on standard error, what will run on what.
pub fn announce(engine: &Dry, folder: &Path, last: u64) {
    let simulation = &engine.simulation;
    let (setup, blocks) = (simulation.setup(), simulation.blocks());
    let parts: usize = setup.blocks.iter().map(|b| b.shape.parts().len()).sum();
    let count = |wanted: fn(&Motion) -> bool| {
        let motions = setup.blocks.iter().map(|block| &block.motion);
        motions.filter(|motion| wanted(motion)).count()
    };
    eprintln!("{}", simulation.scene().title);
    eprintln!(
        "  blocks    {}: {} free, {} driven, {} fixed; {parts} parts",
        blocks.len(),
        count(|motion| *motion == Motion::Free),
        count(|motion| matches!(motion, Motion::Driven { .. })),
        count(|motion| *motion == Motion::Fixed),
    );
    for line in left_out(simulation.left_out()) {
        eprintln!("  left out  {line}");
    }
    eprintln!(
        "  search    {}, skin {:.3e} m",
        simulation.finder().describe(),
        blocks.skin()
    );
    eprintln!(
        "  step      Δt = {:.4e} s, sub-steps of at most {:.4e} s",
        simulation.time_step(),
        blocks.time_step()
    );
    eprintln!(
        "  run       {} to step {last}, {:.6} s; into {}",
        simulation.step(),
        last as f64 * engine.time_step(),
        folder.display()
    );
}
