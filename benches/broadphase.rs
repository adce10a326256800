//! Finding pairs on the host, and on every adapter or the one whose name contains
//! `$RIPRAP_ADAPTER`: boxes of one size and of sizes 1:100.
//!
//! Times are CPU time of all threads on the host and on software adapters, wall time of the whole
//! call, both ways of the data included, on GPUs. At the end a table gives the fastest sample of
//! each, and the exponent p of cost ∝ Nᵖ. 0.04 of it (1:100: 0.06) is no cost of the search: at
//! the surface of a scene there are fewer pairs, and small scenes have more surface.

use cpu_time::ProcessTime;
use criterion::{BenchmarkId, Criterion, Throughput};
use kit::{broadphase::scattered, gpu};
use riprap::{
    Error,
    rock::broadphase::{Aabb, Broadphase, DeviceBroadphase, HostBroadphase},
    wgpu,
};
use std::time::{Duration, Instant};

const COUNTS: [u32; 7] = [100, 316, 1000, 3162, 10_000, 31_623, 100_000];
const RATIOS: [f64; 2] = [1.0, 100.0];

/// A hanging driver is given up after this.
const PATIENCE: Duration = Duration::from_secs(300);

/// Which clock tells the cost.
#[derive(Clone, Copy)]
enum Cost {
    Cpu,
    Wall,
}

impl Cost {
    fn of(self, turn: impl FnOnce()) -> Duration {
        let (wall, cpu) = (Instant::now(), ProcessTime::now());
        turn();
        match self {
            Self::Cpu => cpu.elapsed(),
            Self::Wall => wall.elapsed(),
        }
    }
}

fn main() -> Result<(), Error> {
    let mut criterion = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(100))
        .measurement_time(Duration::from_millis(300))
        .configure_from_args();
    let scenes = RATIOS.map(|ratio| COUNTS.map(|n| different(n, ratio)));
    let mut table = Vec::new();
    measure(
        &mut criterion,
        "host",
        Cost::Cpu,
        &scenes,
        &mut table,
        |items| pollster::block_on(HostBroadphase.pairs(items)),
    );
    let wanted = std::env::var("RIPRAP_ADAPTER").unwrap_or_default();
    for adapter in gpu::adapters() {
        let info = adapter.get_info();
        let name = gpu::describe(&info);
        if !name.to_lowercase().contains(&wanted.to_lowercase()) {
            continue;
        }
        let (device, queue) = gpu::open(&adapter, wgpu::Features::empty(), adapter.limits())?;
        let mut finder = DeviceBroadphase::new(&device, &queue)?;
        let cost = match gpu::is_software(&info) {
            true => Cost::Cpu,
            false => Cost::Wall,
        };
        let name = format!("device/{name}");
        measure(&mut criterion, &name, cost, &scenes, &mut table, |items| {
            gpu::drive(&device, PATIENCE, "a search", finder.pairs(items))?
        });
    }
    criterion.final_summary();
    print(&table);
    Ok(())
}

/// Scenes to take in turn: branch predictors learn a short one by heart.
fn different(count: u32, ratio: f64) -> Vec<Vec<Aabb>> {
    let seeds = 0..(30_000 / count).max(1);
    let scenes = seeds.map(|seed| scattered(count, ratio, seed.into()));
    scenes.collect()
}

/// A finder on boxes of one mixture of sizes: seconds for each count.
struct Row {
    name: String,
    ratio: f64,
    seconds: [f64; COUNTS.len()],
}

fn measure(
    criterion: &mut Criterion,
    name: &str,
    cost: Cost,
    scenes: &[[Vec<Vec<Aabb>>; COUNTS.len()]],
    table: &mut Vec<Row>,
    mut find: impl FnMut(&[Aabb]) -> Result<Vec<[u32; 2]>, Error>,
) {
    let mut group = criterion.benchmark_group(format!("broadphase/{name}"));
    for (scenes, ratio) in scenes.iter().zip(RATIOS) {
        let mut seconds = [f64::INFINITY; COUNTS.len()];
        for ((count, scenes), best) in COUNTS.iter().zip(scenes).zip(&mut seconds) {
            let mut turn = scenes.iter().cycle();
            group.throughput(Throughput::Elements((*count).into()));
            let id = BenchmarkId::new(format!("sizes 1 to {ratio}"), count);
            group.bench_function(id, |bencher| {
                bencher.iter_custom(|turns| {
                    let scenes: Vec<_> = turn.by_ref().take(turns as usize).collect();
                    let total = cost.of(|| {
                        for items in &scenes {
                            match find(items) {
                                Ok(pairs) => drop(std::hint::black_box(pairs)),
                                Err(error) => panic!("{name}: {error}"),
                            }
                        }
                    });
                    *best = best.min(total.as_secs_f64() / turns as f64);
                    // Criterion divides by it.
                    total.max(Duration::from_nanos(1))
                });
            });
        }
        table.push(Row {
            name: name.into(),
            ratio,
            seconds,
        });
    }
    group.finish();
}

/// The slope of ln y over ln x by least squares.
fn exponent(points: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let logs = points.map(|(x, y)| (x.ln(), y.ln()));
    let n = logs.clone().count() as f64;
    let mean = |f: fn((f64, f64)) -> f64| logs.clone().map(f).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let covariance: f64 = logs.clone().map(|p| (p.0 - x) * (p.1 - y)).sum();
    covariance / logs.map(|p| (p.0 - x).powi(2)).sum::<f64>()
}

fn print(table: &[Row]) {
    println!("\nFastest of the samples, microseconds; p over 10² to 10⁵ and over 10³ to 10⁵ items");
    let heads: String = COUNTS.iter().map(|n| format!("{n:>10}")).collect();
    println!("{:>8}{heads}       p       p  finder", "sizes");
    for row in table
        .iter()
        .filter(|r| r.seconds.iter().all(|s| s.is_finite()))
    {
        let cells: String = row
            .seconds
            .iter()
            .map(|s| format!("{:>10.0}", 1e6 * s))
            .collect();
        let points = COUNTS.iter().map(|&n| f64::from(n)).zip(row.seconds);
        let (all, many) = (exponent(points.clone()), exponent(points.skip(2)));
        let sizes = format!("1:{}", row.ratio);
        println!("{sizes:>8}{cells}{all:>8.2}{many:>8.2}  {}", row.name);
    }
}
