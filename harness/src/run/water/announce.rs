//! Header of a run with free water.

use super::{super::summary::Summary, Engine, SphRun};
use crate::{gpu, search::left_out};
use std::path::Path;

/// Prints the scene, the adapter and the steps of the run to standard error.
pub fn announce(engine: &SphRun, summary: &Summary, folder: &Path, last: u64) {
    let simulation = &engine.simulation;
    let setup = simulation.particles().setup();
    eprintln!("{}", simulation.scene().title);
    eprintln!("  adapter   {}", gpu::describe(&engine.adapter));
    if let Some(pool) = &summary.pool {
        eprintln!(
            "  water     {} particles of {:.4e} m, {} boundary particles; speed of sound {:.2} m/s",
            pool.particles, pool.spacing, pool.shell, pool.sound_speed
        );
    }
    eprintln!(
        "  step      Δt = {:.4e} s, acoustic steps of at most {:.4e} s",
        simulation.time_step(),
        setup.acoustic_step()
    );
    if let Some(rock) = engine.rock() {
        eprintln!("  blocks    {}", rock.counted());
    }
    for line in left_out(&simulation.setup().left_out) {
        eprintln!("  left out  {line}");
    }
    eprintln!(
        "  run       {} to step {last}, {:.6} s; into {}",
        simulation.step(),
        last as f64 * engine.time_step(),
        folder.display()
    );
    for warning in &engine.warnings {
        eprintln!("warning: {warning}");
    }
}
