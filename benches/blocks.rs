//! A step of a settled rock mass over its number of blocks, on one core and on all.
//!
//! An iteration is a step. Times are CPU time on one core and wall time on all. At the end a table
//! gives the fastest sample of each, and the exponent p of cost ∝ Nᵖ.

use cpu_time::ThreadTime;
use criterion::{BenchmarkId, Criterion, Throughput};
use kit::{exponent::exponent, pile::Pile};
use riprap::Error;
use std::time::{Duration, Instant};

const COUNTS: [usize; 5] = [100, 316, 1000, 3162, 10_000];

/// Fastest step of a pile, s: CPU time of one core, wall time of all.
struct Row {
    free: usize,
    seconds: [f64; 2],
}

fn main() -> Result<(), Error> {
    let mut criterion = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(600))
        .configure_from_args();
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let one = one.map_err(|e| Error::argument("threads", e.to_string()))?;
    let mut table = Vec::new();
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
        let mut seconds = [f64::INFINITY; 2];
        group.throughput(Throughput::Elements(pile.free as u64));
        for (place, name) in ["one core", "all cores"].into_iter().enumerate() {
            let best = &mut seconds[place];
            let pile = &mut pile;
            group.bench_function(BenchmarkId::new(name, pile.free), |bencher| {
                bencher.iter_custom(|steps| {
                    let mut total = Duration::ZERO;
                    for _ in 0..steps {
                        let spent = match place {
                            0 => one.install(|| {
                                let start = ThreadTime::now();
                                step(pile);
                                start.elapsed()
                            }),
                            _ => {
                                let start = Instant::now();
                                step(pile);
                                start.elapsed()
                            }
                        };
                        *best = best.min(spent.as_secs_f64());
                        total += spent;
                    }
                    // Criterion divides by it.
                    total.max(Duration::from_nanos(1))
                });
            });
        }
        table.push(Row {
            free: pile.free,
            seconds,
        });
    }
    group.finish();
    criterion.final_summary();
    print(&table);
    Ok(())
}

fn step(pile: &mut Pile) {
    if let Err(error) = pile.step() {
        panic!("a pile at rest: {error}");
    }
}

fn print(table: &[Row]) {
    println!("\nFastest of the samples, microseconds: CPU on one core, wall on all");
    println!("{:>8}{:>12}{:>12}", "blocks", "one core", "all cores");
    for row in table {
        let [one, all] = row.seconds.map(|s| 1e6 * s);
        println!("{:>8}{one:>12.0}{all:>12.0}", row.free);
    }
    let p = [0, 1].map(|place| {
        let points = table
            .iter()
            .map(|row| (row.free as f64, row.seconds[place]));
        let measured: Vec<_> = points.filter(|point| point.1.is_finite()).collect();
        exponent(&measured).map_or("-".into(), |p| format!("{p:.2}"))
    });
    println!("{:>8}{:>12}{:>12}", "p", p[0], p[1]);
}
