//! Steps of free water on every adapter, or on the one whose name contains `$RIPRAP_ADAPTER`: a cube of water in a
//! tank, of 20³ and 40³ particles (`$RIPRAP_PARTICLES` gives other numbers along an edge, separated by commas).
//!
//! Times are CPU time divided by the number of cores on software adapters, wall time on others. Pairs are those within the
//! support, each counted twice, as the kernels visit them from both particles.

use criterion::{BenchmarkId, Criterion, Throughput};
use kit::{
    clock::{Clock, PATIENCE},
    gpu,
    tank::Tank,
};
use riprap::{sph::NeighbourSearch, wgpu};
use std::time::Duration;

/// Particles along an edge.
const EDGES: [u32; 2] = [20, 40];
/// Steps between two readings of the clock.
const STEPS: u32 = 4;

fn main() -> Result<(), riprap::Error> {
    let mut criterion = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_secs(2))
        .configure_from_args();
    let edges = std::env::var("RIPRAP_PARTICLES").unwrap_or_default();
    let edges: Vec<u32> = edges
        .split(',')
        .filter_map(|edge| edge.trim().parse().ok())
        .collect();
    let edges = match &edges[..] {
        [] => &EDGES,
        given => given,
    };
    for adapter in gpu::wanted() {
        for &edge in edges {
            bench(&mut criterion, &adapter, edge)?;
        }
    }
    criterion.final_summary();
    Ok(())
}

fn bench(
    criterion: &mut Criterion,
    adapter: &wgpu::Adapter,
    edge: u32,
) -> Result<(), riprap::Error> {
    let (device, queue) = gpu::open(adapter, wgpu::Features::empty(), adapter.limits())?;
    let info = adapter.get_info();
    let (name, software) = (gpu::describe(&info), gpu::is_software(&info));
    let neighbours = if software {
        NeighbourSearch::Lists
    } else {
        NeighbourSearch::Cells
    };
    let mut tank = Tank::fill(&device, &queue, edge, neighbours)?;
    let clock = Clock::new(&device, &queue, software);
    println!(
        "{} particles, {:.1} neighbours, {:.2} million pairs a step",
        tank.count,
        tank.neighbours,
        tank.pairs / 1e6
    );
    let mut group = criterion.benchmark_group("particles");
    group.throughput(Throughput::Elements(tank.count as u64 * u64::from(STEPS)));
    group.bench_function(BenchmarkId::new(tank.count.to_string(), name), |bencher| {
        bencher.iter_custom(|iterations| {
            let mut total = 0.0;
            for _ in 0..iterations {
                let mut taken = 0;
                let spent = clock.time(|| {
                    let done = tank.advance(&device, &queue, STEPS);
                    [taken, _] = gpu::drive(&device, PATIENCE, "a step", done)??;
                    Ok::<_, riprap::Error>(())
                });
                let spent = clock.basis(spent.expect("a device"));
                total += spent / f64::from(taken) * f64::from(STEPS);
            }
            Duration::from_secs_f64(total).max(Duration::from_nanos(1))
        });
    });
    group.finish();
    Ok(())
}
