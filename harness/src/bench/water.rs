//! Steps of free water: particles and pairs per second.

use super::{Bench, copy_bandwidth};
use kit::{
    clock::{Clock, PATIENCE, exponent},
    gpu,
    tank::Tank,
};
use riprap::sph::NeighbourSearch;
use serde::Serialize;

/// Steps between two clock readings.
const STEPS: u32 = 4;
/// Longest expected step, s, of a size that is tried: by default, and with `--full`.
const LONGEST: [f64; 2] = [1.5, 15.0];
/// Clock readings; the larger number for steps up to the first of these limits.
const ROUNDS: [u32; 2] = [3, 7];
/// Pairs per second that a GPU should reach.
const TARGET: f64 = 1e10;
/// Bytes that a pair reads of the other particle in the sums of momentum and continuity on average, without lists: the particle
/// and, in the second sum, its new velocity too.
const BYTES: f64 = 0.5 * (32.0 + 48.0);

/// Least bytes that a step moves per particle, wherever the others are: its sort reads and writes it (32 each), momentum
/// reads it and writes velocity and works (32 + 16 + 12), walls read the works (12), continuity reads it with its velocity and
/// writes it (48 + 32), the search of the longest step reads velocity and works (28).
const OWN_BYTES: f64 = 64.0 + 60.0 + 12.0 + 80.0 + 28.0;
/// Largest number of bytes copied to measure the copy bandwidth.
const COPIED: u64 = 256 << 20;
/// Bytes of a neighbour list that both sums read per neighbour.
const LIST_BYTES: f64 = 8.0;
/// Operations of a pair in a sum, the mean of momentum (45) and continuity (38), as written in the kernels: roots and divisions
/// count as one.
const FLOPS: f64 = 0.5 * (45.0 + 38.0);
/// Steps per particle along the edge after which a dam has broken: about 0.3 s, the front half way.
const BROKEN: u32 = 10;

/// Result for a tank.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Kind of record: `water`.
    pub part: &'static str,
    /// Whether the water moves: a dam break, half way.
    pub moving: bool,
    /// Method of the neighbour search.
    pub neighbours: String,
    /// Particles of water.
    pub particles: usize,
    /// Neighbours of each, on average.
    pub around: f64,
    /// Time of a step, s: CPU time over the cores on software adapters.
    pub step: f64,
    /// Updates of water particles per second; those of walls, which each step computes too, are not counted.
    pub particles_a_second: f64,
    /// Pairs per second, counted for each particle of a pair and for each sum.
    pub pairs_a_second: f64,
    /// Bytes read of the other particles of pairs per second; most of them come from caches.
    pub bytes_a_second: f64,
    /// Fraction of the steps that sorted the particles and, if there are any, rebuilt the neighbour lists.
    pub sorted: f64,
    /// Least bytes that a step moves per particle.
    pub bytes_a_particle: f64,
    /// Bytes that the device copies per second, read and written.
    pub bandwidth: f64,
    /// Fraction of the bandwidth that these bytes take.
    pub bandwidth_share: f64,
    /// Operations of pairs per second.
    pub flops: f64,
}

/// Measures tanks of growing size and prints a table as it goes.
pub fn measure(bench: &Bench<'_>) -> anyhow::Result<Vec<Row>> {
    let Bench {
        device,
        queue,
        quick,
        full,
        ..
    } = *bench;
    let software = bench.machine.software;
    let bandwidth = copy_bandwidth(device, queue, COPIED)?;
    let clock = bench.clock();
    println!(
        "\nwater, h/Δx = 2; the device copies {:.1} GB/s\n{:>10} {:>6} {:>7} {:>11} {:>7} {:>10} {:>16} {:>16} {:>10} {:>10} \
         {:>9}",
        bandwidth / 1e9,
        "particles",
        "around",
        "",
        "neighbours",
        "sorted",
        "ms a step",
        "10⁶ particles/s",
        "10⁶ pairs/s",
        "GB/s",
        "of copies",
        "GFLOP/s"
    );
    let edges: &[u32] = match (quick, full) {
        (true, _) => &[22],
        (_, true) => &[22, 46, 100],
        (false, false) => &[22, 46],
    };
    let kinds: &[NeighbourSearch] = match software {
        true => &[NeighbourSearch::Lists, NeighbourSearch::Cells],
        false => &[NeighbourSearch::Cells, NeighbourSearch::Lists],
    };
    let (mut rows, mut moving): (Vec<Row>, Vec<Row>) = (Vec::new(), Vec::new());
    for &edge in edges {
        for &neighbours in kinds {
            let name = format!("{neighbours:?}");
            let last = rows.iter().rev().find(|row| row.neighbours == name);
            if last.is_some_and(|row| 8.0 * row.step > LONGEST[usize::from(full)]) {
                let count = edge.pow(3);
                println!("{count:>10} {name}: left out, a step would take seconds");
                continue;
            }
            let tank = Tank::fill(device, queue, edge, neighbours)?;
            let rounds = |step: f64| ROUNDS[usize::from(!quick && step <= LONGEST[0])];
            rows.push(time(&clock, bandwidth, tank, neighbours, rounds)?);
            if edge == edges[0] {
                let mut dam = Tank::dam(device, queue, edge, neighbours)?;
                let broken = dam.advance(device, queue, BROKEN * edge);
                gpu::drive(device, PATIENCE, "a dam break", broken)??;
                let count = dam.count(device, queue);
                gpu::drive(device, PATIENCE, "counting pairs", count)??;
                moving.push(time(&clock, bandwidth, dam, neighbours, rounds)?);
            }
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
    if !software {
        let rates = rows.iter().map(|row| row.pairs_a_second);
        let best = rates.fold(0.0, f64::max);
        let verdict = if best >= TARGET { "met" } else { "missed" };
        println!("target {TARGET:.0e} pairs a second: {best:.2e}, {verdict}");
    }
    rows.extend(moving);
    Ok(rows)
}

/// Times the steps of a tank and prints the row. `rounds` gives the number of rounds for the time of a step (s); `bandwidth` is
/// the number of bytes that the device copies per second.
fn time(
    clock: &Clock,
    bandwidth: f64,
    mut tank: Tank,
    neighbours: NeighbourSearch,
    rounds: impl Fn(f64) -> u32,
) -> anyhow::Result<Row> {
    let (device, queue) = (&clock.device, &clock.queue);
    let moving = tank.particles.max_speed() > 0.0;
    let (mut step, mut round) = (f64::INFINITY, 0);
    let (mut all, mut sorted) = (0.0, 0.0);
    while round < rounds(step) {
        let (mut steps, mut sorts) = (0.0, 0.0);
        let spent = clock.time(|| -> riprap::Result<()> {
            let done = tank.advance(device, queue, STEPS);
            [steps, sorts] = gpu::drive(device, PATIENCE, "free water", done)??.map(f64::from);
            Ok(())
        })?;
        let spent = clock.basis(spent);
        // Lists make some steps longer than others: for moving water the mean counts.
        step = match moving {
            true if all > 0.0 => (step * all + spent) / (all + steps),
            _ => step.min(spent / steps),
        };
        (all, sorted) = (all + steps, sorted + sorts);
        round += 1;
    }
    let lists = match neighbours {
        NeighbourSearch::Lists => LIST_BYTES * tank.neighbours,
        NeighbourSearch::Cells => 0.0,
    };
    let bytes_a_particle = OWN_BYTES + lists;
    let particles_a_second = tank.count as f64 / step;
    let row = Row {
        part: "water",
        moving,
        neighbours: format!("{neighbours:?}"),
        particles: tank.count,
        around: tank.neighbours,
        step,
        particles_a_second,
        pairs_a_second: tank.pairs / step,
        bytes_a_second: BYTES * tank.pairs / step,
        sorted: sorted / all,
        bytes_a_particle,
        bandwidth,
        bandwidth_share: bytes_a_particle * particles_a_second / bandwidth,
        flops: FLOPS * tank.pairs / step,
    };
    println!(
        "{:>10} {:>6.1} {:>7} {:>11} {:>6.0}% {:>10.2} {:>16.3} {:>16.1} {:>10.2} {:>9.1}% {:>9.2}",
        row.particles,
        row.around,
        if row.moving { "moving" } else { "at rest" },
        row.neighbours,
        100.0 * row.sorted,
        1e3 * row.step,
        row.particles_a_second / 1e6,
        row.pairs_a_second / 1e6,
        row.bytes_a_second / 1e9,
        100.0 * row.bandwidth_share,
        row.flops / 1e9
    );
    Ok(row)
}
