//! Time of a step of a settled rock mass for several numbers of blocks, on one core and on all cores.
//!
//! An iteration is a step. Times are CPU time on one core and wall time on all. `riprap bench --only rock` reports the
//! exponent of cost ∝ Nᵖ.

use cpu_time::ThreadTime;
use criterion::{BenchmarkId, Criterion, Throughput};
use kit::pile::Pile;
use riprap::Error;
use std::time::{Duration, Instant};

const COUNTS: [usize; 5] = [100, 316, 1000, 3162, 10_000];

fn main() -> Result<(), Error> {
    let mut criterion = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(600))
        .configure_from_args();
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let one = one.map_err(|e| Error::argument("threads", e.to_string()))?;
    let mut group = criterion.benchmark_group("blocks/step");
    for count in COUNTS {
        let mut pile = Pile::settled(count)?;
        println!(
            "{} free blocks, {} candidates, {} contacts, {:.1e} m/s after {} steps",
            pile.free,
            pile.blocks.candidate_pair_count(),
            pile.blocks.contacts().count(),
            pile.blocks.largest_speed(),
            pile.steps
        );
        group.throughput(Throughput::Elements(pile.free as u64));
        let mut step = || pile.step().expect("a pile at rest");
        let mut on_one = |steps: u64| {
            one.install(|| {
                let start = ThreadTime::now();
                (0..steps).for_each(|_| step());
                start.elapsed()
            })
        };
        // Criterion divides by the time, so it must not be zero.
        let least = Duration::from_nanos(1);
        group.bench_function(BenchmarkId::new("one core", count), |bencher| {
            bencher.iter_custom(|steps| on_one(steps).max(least));
        });
        let mut on_all = |steps: u64| {
            let start = Instant::now();
            (0..steps).for_each(|_| step());
            start.elapsed()
        };
        group.bench_function(BenchmarkId::new("all cores", count), |bencher| {
            bencher.iter_custom(|steps| on_all(steps).max(least));
        });
    }
    group.finish();
    criterion.final_summary();
    Ok(())
}
