//! A short trial of a scene, from which its running time follows.

use super::report::Time;
use crate::gpu;
use riprap::{Result, simulation::Simulation, wgpu};
use std::time::{Duration, Instant};

/// How long a few steps may take before the device counts as lost.
pub const PATIENCE: Duration = Duration::from_secs(60);
/// Length of the trial: enough that the start of a submission, some 0.1 ms, does not count.
const TRIAL: Duration = Duration::from_millis(400);

/// Runs steps for less than half a second, at least one.
///
/// # Errors
/// If the flow diverges or the device is lost.
pub fn time(simulation: &mut Simulation, device: &wgpu::Device) -> Result<Time> {
    let steps = simulation.scene().run.step_count(simulation.units());
    let mut advance = |steps| {
        let start = Instant::now();
        let future = simulation.advance(steps);
        gpu::drive(device, PATIENCE, "the first steps", future)??;
        Ok(start.elapsed())
    };
    // Drivers compile at the first dispatch, and the first step has no boundary passes.
    advance(4)?;
    let mut left = TRIAL;
    let (mut done, mut spent) = (0, Duration::ZERO);
    let mut turn = 1;
    loop {
        let took = advance(turn)?;
        (done, spent) = (done + turn, spent + took);
        left = left.saturating_sub(took);
        // The next turn is twice as long.
        if left < 2 * took {
            break;
        }
        turn *= 2;
    }
    let step = spent.as_secs_f64() / done as f64;
    let cells = simulation.lattice().geometry().fluid_cells as f64;
    Ok(Time {
        step,
        run: step * steps as f64,
        cells_a_second: cells / step,
        trial_steps: done,
    })
}
