//! What a run of blocks says before it starts.

use super::{Dry, Engine};
use crate::search::left_out;
use std::path::Path;

/// Tells, on standard error, what will run on what.
pub fn announce(engine: &Dry, folder: &Path, last: u64) {
    let simulation = &engine.simulation;
    let blocks = simulation.blocks();
    eprintln!("{}", simulation.scene().title);
    if let Some(rock) = engine.rock() {
        eprintln!("  blocks    {}", rock.counted());
    }
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
    for warning in engine.warnings() {
        eprintln!("warning: {warning}");
    }
}
