//! The fluid step and copies on every adapter, or on the one whose name contains `$RIPRAP_ADAPTER`.
//!
//! One iteration is two steps, an even and an odd one. Times are GPU time, CPU time over the cores
//! on software adapters, wall time where a GPU has no timestamps. At the end a table compares the
//! adapters.

use criterion::{BenchmarkId, Criterion, Throughput};
use kit::{
    clock::Clock,
    copy::{Copy, METHODS},
    flow, gpu,
    stream_only::StreamOnly,
    subject::Subject,
};
use riprap::{
    Error,
    lattice::{Collision, Force, Lattice, Setup, Storage},
    wgpu,
};
use std::{collections::BTreeMap, time::Duration};

/// Kernel and variant → adapter → million cells, or megabytes, a second.
type Table = BTreeMap<String, BTreeMap<String, f64>>;

type Change = fn(&mut Setup);

const VARIANTS: [(&str, Change); 7] = [
    ("mrt", |_| {}),
    ("bgk", |s| s.collision = Collision::Bgk),
    ("force", |s| s.force = Force::Constant([1e-6, 0.0, 0.0])),
    ("wale", |s| s.wale = Some(0.5)),
    ("guard", |s| s.max_speed = 0.3),
    ("16-bit", |s| {
        (s.storage, s.lanes) = (Storage::F16, s.lanes.max(2));
    }),
    (STREAM_ONLY, |_| {}),
];

const STREAM_ONLY: &str = "stream only";

fn main() -> Result<(), Error> {
    let mut criterion = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(500))
        .configure_from_args();
    let wanted = std::env::var("RIPRAP_ADAPTER").unwrap_or_default();
    let mut table = Table::new();
    for adapter in gpu::adapters() {
        let name = gpu::describe(&adapter.get_info());
        if name.to_lowercase().contains(&wanted.to_lowercase()) {
            bench(&mut criterion, &adapter, &name, &mut table)?;
        }
    }
    criterion.final_summary();
    print(&table);
    Ok(())
}

fn bench(
    criterion: &mut Criterion,
    adapter: &wgpu::Adapter,
    name: &str,
    table: &mut Table,
) -> Result<(), Error> {
    let wanted = wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::SHADER_INT64;
    let (device, queue) = gpu::open(adapter, adapter.features() & wanted, adapter.limits())?;
    let software = gpu::is_software(&adapter.get_info());
    let mut clock = Clock::new(&device, &queue, software);
    for n in [32u32, 64] {
        for (variant, change) in VARIANTS {
            let mut setup = Setup::periodic([n; 3], 0.01);
            setup.max_speed = 0.0;
            if software {
                setup.lanes = 4;
                setup.suit_cpu(device.features());
            }
            change(&mut setup);
            let state = flow::sheared_noise(&setup)?;
            let mut lattice = Lattice::new(&device, setup)?;
            lattice.start(&device, &queue, &state, true)?;
            let subject = match variant {
                STREAM_ONLY => Subject::Streaming(Box::new(StreamOnly::new(&device, lattice)?)),
                _ => Subject::Steps(Box::new(lattice)),
            };
            let id = Id {
                kernel: "collide_stream",
                variant: format!("{variant} {n}³"),
                adapter: name,
                throughput: Throughput::Elements(2 * u64::from(n).pow(3)),
            };
            id.measure(criterion, &mut clock, subject, table);
        }
    }
    let copy = Copy::new(&device, 32 << 20)?;
    for method in METHODS {
        let id = Id {
            kernel: "copy",
            variant: format!("{method:?}"),
            adapter: name,
            throughput: Throughput::Bytes(2 * copy.traffic() as u64),
        };
        id.measure(
            criterion,
            &mut clock,
            Subject::Copying(&copy, method),
            table,
        );
    }
    Ok(())
}

/// What a measurement is called, and what one iteration does.
struct Id<'a> {
    kernel: &'a str,
    variant: String,
    adapter: &'a str,
    throughput: Throughput,
}

impl Id<'_> {
    fn measure(
        self,
        criterion: &mut Criterion,
        clock: &mut Clock,
        mut subject: Subject<'_>,
        table: &mut Table,
    ) {
        let mut group = criterion.benchmark_group(self.kernel);
        group.throughput(self.throughput.clone());
        let mut best = f64::INFINITY;
        group.bench_function(BenchmarkId::new(&self.variant, self.adapter), |bencher| {
            bencher.iter_custom(|iterations| {
                // Submissions stay short: drivers reset a GPU that is busy for seconds.
                let mut total = 0.0;
                let mut left = iterations;
                while left > 0 {
                    let now = left.min(32);
                    match clock.run(&mut subject, 2 * now as u32) {
                        Ok(spent) => {
                            best = best.min(2.0 * spent.basis);
                            total += 2.0 * spent.basis * now as f64;
                        }
                        Err(error) => panic!("{}: {error}", self.adapter),
                    }
                    left -= now;
                }
                // Criterion divides by it.
                Duration::from_secs_f64(total).max(Duration::from_nanos(1))
            });
        });
        group.finish();
        let done = match self.throughput {
            Throughput::Elements(n) | Throughput::Bytes(n) => n as f64,
            _ => 0.0,
        };
        if best.is_finite() {
            let row = table.entry(format!("{}/{}", self.kernel, self.variant));
            row.or_default()
                .insert(self.adapter.into(), done / best / 1e6);
        }
    }
}

/// One row a kernel, one column an adapter.
fn print(table: &Table) {
    let mut adapters: Vec<_> = table.values().flat_map(BTreeMap::keys).collect();
    adapters.sort();
    adapters.dedup();
    println!("\nFastest of the samples: MLUPS of collide_stream, MB/s of copy");
    for (n, adapter) in adapters.iter().enumerate() {
        println!("  [{n}] {adapter}");
    }
    let heads: String = (0..adapters.len())
        .map(|n| format!("{:>11}", format!("[{n}]")))
        .collect();
    println!("{:<32}{heads}", "");
    for (kernel, row) in table {
        let cells = adapters.iter().map(|adapter| match row.get(*adapter) {
            Some(speed) => format!("{speed:>11.1}"),
            None => format!("{:>11}", "-"),
        });
        println!("{kernel:<32}{}", cells.collect::<String>());
    }
}
