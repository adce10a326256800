//! Steps of free water on every adapter, or on the one whose name contains `$RIPRAP_ADAPTER`: a cube of water in a
//! tank, of some thousand to a million particles (`$RIPRAP_PARTICLES` names other numbers of them along an edge).
//!
//! Times are CPU time over the cores on software adapters, wall time on others. Pairs are those within the support,
//! each counted once for each of its two ends, as the kernels meet them.

use cpu_time::ProcessTime;
use criterion::{BenchmarkId, Criterion, Throughput};
use kit::{gpu, tank::Tank};
use riprap::{sph::NeighbourSearch, wgpu};
use std::time::{Duration, Instant};

/// Particles along an edge.
const EDGES: [u32; 2] = [20, 40];
/// Steps between two looks at the clock.
const STEPS: u32 = 4;

fn main() -> Result<(), riprap::Error> {
    let mut criterion = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_secs(2))
        .configure_from_args();
    let wanted = std::env::var("RIPRAP_ADAPTER").unwrap_or_default();
    let edges = std::env::var("RIPRAP_PARTICLES").unwrap_or_default();
    let edges: Vec<u32> = edges
        .split(',')
        .filter_map(|edge| edge.trim().parse().ok())
        .collect();
    let edges = if edges.is_empty() {
        EDGES.to_vec()
    } else {
        edges
    };
    let mut rows = Vec::new();
    for adapter in gpu::adapters() {
        let name = gpu::describe(&adapter.get_info());
        if name.to_lowercase().contains(&wanted.to_lowercase()) {
            for &edge in &edges {
                rows.push(bench(&mut criterion, &adapter, &name, edge)?);
            }
        }
    }
    criterion.final_summary();
    println!("\nFastest of the samples");
    for row in rows {
        println!("{row}");
    }
    Ok(())
}

fn bench(
    criterion: &mut Criterion,
    adapter: &wgpu::Adapter,
    name: &str,
    edge: u32,
) -> Result<String, riprap::Error> {
    let (device, queue) = gpu::open(adapter, wgpu::Features::empty(), adapter.limits())?;
    let software = gpu::is_software(&adapter.get_info());
    let neighbours = if software {
        NeighbourSearch::Lists
    } else {
        NeighbourSearch::Cells
    };
    let mut tank = Tank::fill(&device, &queue, edge, neighbours)?;
    let count = tank.count;
    let mut best = f64::INFINITY;
    let mut group = criterion.benchmark_group("particles");
    group.throughput(Throughput::Elements(count as u64 * u64::from(STEPS)));
    group.bench_function(BenchmarkId::new(count.to_string(), name), |bencher| {
        bencher.iter_custom(|iterations| {
            let mut total = 0.0;
            for _ in 0..iterations {
                let (cpu, wall) = (ProcessTime::now(), Instant::now());
                let done = tank.advance(&device, &queue, STEPS);
                let done = gpu::drive(&device, Duration::from_secs(300), "a step", done);
                let steps = match done {
                    Ok(Ok([steps, _])) => f64::from(steps),
                    Ok(Err(error)) | Err(error) => panic!("{name}: {error}"),
                };
                let cores = std::thread::available_parallelism().map_or(1, usize::from);
                let spent = match software {
                    true => cpu.elapsed().as_secs_f64() / cores as f64,
                    false => wall.elapsed().as_secs_f64(),
                };
                best = best.min(spent / steps);
                total += spent / steps * f64::from(STEPS);
            }
            Duration::from_secs_f64(total).max(Duration::from_nanos(1))
        });
    });
    group.finish();
    Ok(format!(
        "{count:>9} particles, {:>5.1} neighbours: {:>8.2} ms a step, {:>7.2} million particles/s, {:>9.1} million pairs/s on {name}",
        tank.neighbours,
        1e3 * best,
        count as f64 / best / 1e6,
        tank.pairs / best / 1e6,
    ))
}
