//! The broadphase on the host, and on every adapter or the one whose name contains
//! `$RIPRAP_ADAPTER`: boxes of one size and of sizes 1:100.
//!
//! Times are CPU time of all threads on the host and on software adapters; on GPUs wall time of the whole
//! call, including upload and readback. `riprap bench --only rock` reports the exponent p of cost ∝ Nᵖ. 0.04 of p
//! (1:100: 0.06) is not due to the search: boxes at the surface of a scene have fewer pairs, and small scenes have
//! relatively more surface.

use criterion::{BenchmarkId, Criterion, Throughput};
use kit::{
    broadphase::scattered,
    clock::{PATIENCE, Stopwatch},
    gpu,
};
use riprap::{
    Error,
    rock::broadphase::{Aabb, Broadphase, DeviceBroadphase, HostBroadphase},
    wgpu,
};
use std::time::Duration;

const COUNTS: [u32; 7] = [100, 316, 1000, 3162, 10_000, 31_623, 100_000];
const RATIOS: [f64; 2] = [1.0, 100.0];

fn main() -> Result<(), Error> {
    let mut criterion = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(100))
        .measurement_time(Duration::from_millis(300))
        .configure_from_args();
    measure(&mut criterion, "host", true, |items| {
        pollster::block_on(HostBroadphase.pairs(items))
    });
    for adapter in gpu::wanted() {
        let info = adapter.get_info();
        let (device, queue) = gpu::open(&adapter, wgpu::Features::empty(), adapter.limits())?;
        let mut finder = DeviceBroadphase::new(&device, &queue)?;
        let name = format!("device/{}", gpu::describe(&info));
        let software = gpu::is_software(&info);
        measure(&mut criterion, &name, software, |items| {
            gpu::drive(&device, PATIENCE, "a search", finder.pairs(items))?
        });
    }
    criterion.final_summary();
    Ok(())
}

fn measure(
    criterion: &mut Criterion,
    name: &str,
    by_cpu: bool,
    mut find: impl FnMut(&[Aabb]) -> Result<Vec<[u32; 2]>, Error>,
) {
    let mut group = criterion.benchmark_group(format!("broadphase/{name}"));
    for ratio in RATIOS {
        for count in COUNTS {
            // Alternates between several scenes: branch predictors would memorise a single short one.
            let seeds = 0..(30_000 / count).max(1);
            let scenes: Vec<_> = seeds
                .map(|seed| scattered(count, ratio, seed.into()))
                .collect();
            let mut turn = scenes.iter().cycle();
            group.throughput(Throughput::Elements(count.into()));
            let id = BenchmarkId::new(format!("sizes 1 to {ratio}"), count);
            group.bench_function(id, |bencher| {
                bencher.iter_custom(|turns| {
                    let scenes: Vec<_> = turn.by_ref().take(turns as usize).collect();
                    let watch = Stopwatch::start();
                    for items in &scenes {
                        let pairs = find(items).expect("a search without errors");
                        drop(std::hint::black_box(pairs));
                    }
                    let spent = watch.spent();
                    let seconds = if by_cpu { spent.cpu } else { spent.wall };
                    // Criterion divides by the time, so it must not be zero.
                    Duration::from_secs_f64(seconds).max(Duration::from_nanos(1))
                });
            });
        }
    }
    group.finish();
}
