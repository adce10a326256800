//! Steps of free water: particles and pairs a second.

use super::{report::Machine, rock::exponent, tank::Tank};
use crate::gpu;
use cpu_time::ProcessTime;
use riprap::{particles::Neighbours, wgpu};
use serde::Serialize;
use std::time::{Duration, Instant};

/// Steps between two looks at the clock.
const STEPS: u32 = 4;
/// Longest silence of a device that is not taken for a hang.
const PATIENCE: Duration = Duration::from_secs(300);
/// A step that takes longer, s, is the last that is tried, also where all sizes are wanted.
const LONGEST: [f64; 2] = [1.5, 15.0];
/// Looks at the clock: more where steps take less than the longest.
const ROUNDS: [u32; 2] = [3, 7];
/// Pairs a second that a GPU should reach.
const TARGET: f64 = 1e10;
/// Bytes that a pair reads of its other end in the sums of momentum and continuity, without lists: a particle, and in
/// the second its new velocity too.
const BYTES: f64 = 0.5 * (32.0 + 48.0);

/// A tank that was timed.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Where.
    #[serde(flatten)]
    pub machine: Machine,
    /// What: `water`.
    pub part: &'static str,
    /// How neighbours were found.
    pub neighbours: String,
    /// Particles of water.
    pub particles: usize,
    /// Neighbours of each, on average.
    pub around: f64,
    /// Time of a step, s: CPU time over the cores on software adapters.
    pub step: f64,
    /// Particles a second.
    pub particles_a_second: f64,
    /// Pairs a second, each pair once for each of its ends and for each sum.
    pub pairs_a_second: f64,
    /// Bytes of the other ends of pairs a second: most of them come from caches.
    pub bytes_a_second: f64,
}

/// Measures tanks of growing size and prints a table as it goes.
///
/// # Errors
/// If the device fails.
pub fn measure(
    (quick, full): (bool, bool),
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    machine: &Machine,
) -> anyhow::Result<Vec<Row>> {
    println!(
        "\nwater, h/Δx = 2\n{:>10} {:>6} {:>11} {:>10} {:>16} {:>16} {:>10}",
        "particles", "around", "neighbours", "ms a step", "10⁶ particles/s", "10⁶ pairs/s", "GB/s"
    );
    let edges: &[u32] = match (quick, full) {
        (true, _) => &[22],
        (_, true) => &[22, 46, 100],
        (false, false) => &[22, 46],
    };
    let kinds: &[Neighbours] = match machine.software {
        true => &[Neighbours::Lists, Neighbours::Cells],
        false => &[Neighbours::Cells, Neighbours::Lists],
    };
    let mut rows: Vec<Row> = Vec::new();
    for &edge in edges {
        for &neighbours in kinds {
            let slow = |row: &&Row| row.neighbours == format!("{neighbours:?}");
            if rows
                .iter()
                .rev()
                .find(slow)
                .is_some_and(|row| 8.0 * row.step > LONGEST[usize::from(full)])
            {
                println!(
                    "{:>10} {neighbours:?}: left out, a step would take seconds",
                    edge.pow(3)
                );
                continue;
            }
            let mut tank = Tank::fill(device, queue, edge, neighbours)?;
            let mut step = f64::INFINITY;
            let mut round = 0;
            while round < ROUNDS[usize::from(!quick && step <= LONGEST[0])] {
                let (cpu, wall) = (ProcessTime::now(), Instant::now());
                let done = tank.advance(device, queue, STEPS);
                let steps = f64::from(gpu::drive(device, PATIENCE, "free water", done)??);
                let spent = match machine.software {
                    true => cpu.elapsed().as_secs_f64() / machine.cores as f64,
                    false => wall.elapsed().as_secs_f64(),
                };
                step = step.min(spent / steps);
                round += 1;
            }
            let row = Row {
                machine: machine.clone(),
                part: "water",
                neighbours: format!("{neighbours:?}"),
                particles: tank.count,
                around: tank.neighbours,
                step,
                particles_a_second: tank.count as f64 / step,
                pairs_a_second: tank.pairs / step,
                bytes_a_second: BYTES * tank.pairs / step,
            };
            println!(
                "{:>10} {:>6.1} {:>11} {:>10.2} {:>16.3} {:>16.1} {:>10.2}",
                row.particles,
                row.around,
                row.neighbours,
                1e3 * row.step,
                row.particles_a_second / 1e6,
                row.pairs_a_second / 1e6,
                row.bytes_a_second / 1e9
            );
            rows.push(row);
        }
    }
    for neighbours in kinds {
        let name = format!("{neighbours:?}");
        let own = rows.iter().filter(|row| row.neighbours == name);
        let points: Vec<_> = own.map(|row| (row.particles as f64, row.step)).collect();
        if let Some(exponent) = exponent(&points) {
            println!("{name}: a step costs (particles)^{exponent:.2}");
        }
    }
    if !machine.software {
        let best = rows
            .iter()
            .map(|row| row.pairs_a_second)
            .fold(0.0, f64::max);
        let verdict = if best >= TARGET { "met" } else { "missed" };
        println!("target {TARGET:.0e} pairs a second: {best:.2e}, {verdict}");
    }
    Ok(rows)
}
