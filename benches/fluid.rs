//! The fluid step and copies on every adapter, or on the one whose name contains `$RIPRAP_ADAPTER`.
//!
//! One iteration is two steps, an even and an odd one. Times are GPU time, CPU time over the cores
//! on software adapters, wall time where a GPU has no timestamps. At the end a table compares the adapters.

use criterion::{BenchmarkGroup, BenchmarkId, Criterion, Throughput, measurement::WallTime};
use kit::{
    clock::Clock,
    copy::{Copy, METHODS},
    gpu,
    subject::{StreamOnly, Subject, sheared_noise},
};
use riprap::{
    Error,
    lattice::{Collision, Force, Lattice, Setup, Storage},
    wgpu,
};
use std::{collections::BTreeMap, time::Duration};

/// Kernel and variant: million cells, or megabytes, a second on each adapter.
type Table = BTreeMap<String, Vec<f64>>;

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
    let (mut table, mut names) = (Table::new(), Vec::new());
    for adapter in gpu::adapters() {
        let name = gpu::describe(&adapter.get_info());
        if name.to_lowercase().contains(&wanted.to_lowercase()) {
            bench(&mut criterion, &adapter, &name, &mut table)?;
            names.push(name);
        }
    }
    criterion.final_summary();
    println!("\nFastest samples: MLUPS of collide_stream, MB/s of copy");
    for (n, name) in names.iter().enumerate() {
        println!("  [{n}] {name}");
    }
    for (kernel, rates) in &table {
        let rates: String = rates.iter().map(|rate| format!("{rate:>11.1}")).collect();
        println!("{kernel:<32}{rates}");
    }
    Ok(())
}

fn bench(
    criterion: &mut Criterion,
    adapter: &wgpu::Adapter,
    name: &str,
    table: &mut Table,
) -> Result<(), Error> {
    let mut add = |kernel: &str, variant: &str, work: f64, seconds: f64| {
        let rates = table.entry(format!("{kernel}/{variant}")).or_default();
        rates.push(work / seconds / 1e6);
    };
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
            let state = sheared_noise(&setup)?;
            let mut lattice = Lattice::new(&device, setup)?;
            lattice.start(&device, &queue, &state, true)?;
            let subject = match variant {
                STREAM_ONLY => Subject::Streaming(Box::new(StreamOnly::new(&device, lattice)?)),
                _ => Subject::Steps(Box::new(lattice)),
            };
            let mut group = criterion.benchmark_group("collide_stream");
            let cells = 2 * u64::from(n).pow(3);
            group.throughput(Throughput::Elements(cells));
            let variant = format!("{variant} {n}³");
            let id = BenchmarkId::new(&variant, name);
            let seconds = measure(&mut group, id, &mut clock, subject);
            add("collide_stream", &variant, cells as f64, seconds);
        }
    }
    let copy = Copy::new(&device, 32 << 20)?;
    for method in METHODS {
        let mut group = criterion.benchmark_group("copy");
        let bytes = 2 * copy.traffic() as u64;
        group.throughput(Throughput::Bytes(bytes));
        let variant = format!("{method:?}");
        let id = BenchmarkId::new(&variant, name);
        let seconds = measure(&mut group, id, &mut clock, Subject::Copying(&copy, method));
        add("copy", &variant, bytes as f64, seconds);
    }
    Ok(())
}

/// Seconds of the fastest iteration; infinite where the benchmark is not selected.
fn measure(
    group: &mut BenchmarkGroup<'_, WallTime>,
    id: BenchmarkId,
    clock: &mut Clock,
    mut subject: Subject<'_>,
) -> f64 {
    let mut fastest = f64::INFINITY;
    group.bench_function(id, |bencher| {
        bencher.iter_custom(|iterations| {
            // Submissions stay short: drivers reset a GPU that is busy for seconds.
            let mut total = 0.0;
            let mut left = iterations;
            while left > 0 {
                let now = left.min(32);
                let turn = clock.run(&mut subject, 2 * now as u32);
                let seconds = 2.0 * turn.expect("a device").basis;
                fastest = fastest.min(seconds);
                total += seconds * now as f64;
                left -= now;
            }
            // Criterion divides by it.
            Duration::from_secs_f64(total).max(Duration::from_nanos(1))
        });
    });
    fastest
}
