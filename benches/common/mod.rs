//! Shared code of the kernel benches. They run on every adapter, or on the one whose name contains `$RIPRAP_ADAPTER`, and
//! end with a table that compares the adapters.
//!
//! Times are GPU times; CPU time divided by the number of cores on software adapters, and wall time on GPUs without
//! timestamps.

#![allow(dead_code, reason = "each bench uses a part of it")]

use criterion::{BenchmarkId, Criterion, Throughput};
use kit::{clock::Clock, gpu, subject::Subject};
use riprap::{Error, gpu::Processor, lattice::Setup, wgpu};
use std::{collections::BTreeMap, time::Duration};

/// Rate of each kernel and variant on each adapter, in millions per second.
type Table = BTreeMap<String, Vec<f64>>;

/// An adapter on which kernels are measured.
pub struct Adapter<'a> {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub processor: Processor,
    name: String,
    number: usize,
    clock: Clock,
    criterion: &'a mut Criterion,
    table: &'a mut Table,
}

/// Measures on all adapters; `units` names the unit of the rates in the table.
pub fn on_adapters(
    units: &str,
    measure: impl Fn(&mut Adapter<'_>) -> Result<(), Error>,
) -> Result<(), Error> {
    let mut criterion = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(500))
        .configure_from_args();
    let (mut table, mut names) = (Table::new(), Vec::new());
    for adapter in gpu::wanted() {
        let info = adapter.get_info();
        let name = gpu::describe(&info);
        let features = wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::SHADER_INT64;
        let (device, queue) = gpu::open(&adapter, adapter.features() & features, adapter.limits())?;
        measure(&mut Adapter {
            clock: Clock::new(&device, &queue, gpu::is_software(&info)),
            processor: Processor::of(&info),
            device,
            queue,
            name: name.clone(),
            number: names.len(),
            criterion: &mut criterion,
            table: &mut table,
        })?;
        names.push(name);
    }
    criterion.final_summary();
    println!("\nFastest samples: {units}");
    for (n, name) in names.iter().enumerate() {
        println!("  [{n}] {name}");
    }
    for (kernel, rates) in &table {
        let rates: String = rates.iter().map(|rate| format!("{rate:>11.1}")).collect();
        println!("{kernel:<48}{rates}");
    }
    Ok(())
}

impl Adapter<'_> {
    /// A periodic cube without the velocity guard, with lanes and bricks that suit the adapter.
    pub fn setup(&self, n: u32) -> Setup {
        let mut setup = Setup::periodic([n; 3], 0.01);
        setup.max_speed = 0.0;
        match self.processor {
            Processor::Cpu => {
                setup.lanes = 4;
                setup.use_cpu_layout(self.device.features());
            }
            Processor::Gpu => setup.use_gpu_layout(),
        }
        setup
    }

    /// Times a subject; an iteration consists of `turns` turns, which do `work` together. Each submission contains several
    /// iterations, but is short, because drivers reset a GPU that is busy for seconds.
    pub fn turns(
        &mut self,
        kernel: &str,
        variant: &str,
        (turns, work): (u32, Throughput),
        mut subject: Subject<'_>,
    ) {
        self.measure(kernel, variant, work, |clock, iterations| {
            let turn = clock.run(&mut subject, turns * iterations)?;
            Ok(f64::from(turns) * turn.basis)
        });
    }

    /// Times the commands of `record`, once after each `prepare`, which is not timed.
    pub fn prepared<State>(
        &mut self,
        kernel: &str,
        variant: &str,
        work: Throughput,
        state: &mut State,
        mut prepare: impl FnMut(&mut State) -> Result<(), Error>,
        mut record: impl FnMut(&mut State, &mut wgpu::ComputePass<'_>),
    ) {
        self.measure(kernel, variant, work, |clock, iterations| {
            let mut seconds = 0.0;
            for _ in 0..iterations {
                prepare(state)?;
                // Flushes the writes to buffers, which belong to the next submission.
                clock.queue.submit([]);
                clock.wait()?;
                let mut once = |pass: &mut wgpu::ComputePass<'_>| record(state, pass);
                let mut subject = Subject::Recording(Box::new(&mut once));
                seconds += clock.run(&mut subject, 1)?.basis;
            }
            Ok(seconds / f64::from(iterations))
        });
    }

    /// Measures `run`, which returns the seconds per iteration for a number of iterations.
    fn measure(
        &mut self,
        kernel: &str,
        variant: &str,
        work: Throughput,
        mut run: impl FnMut(&mut Clock, u32) -> Result<f64, Error>,
    ) {
        let (Throughput::Elements(units) | Throughput::Bytes(units)) = work else {
            return;
        };
        let mut fastest = f64::INFINITY;
        let clock = &mut self.clock;
        let mut group = self.criterion.benchmark_group(kernel);
        group.throughput(work);
        group.bench_function(BenchmarkId::new(variant, &self.name), |bencher| {
            bencher.iter_custom(|iterations| {
                let (mut total, mut left) = (0.0, iterations);
                while left > 0 {
                    let now = left.min(32);
                    let seconds = run(clock, now as u32).expect("a device");
                    fastest = fastest.min(seconds);
                    total += seconds * now as f64;
                    left -= now;
                }
                // Criterion divides by the time, so it must not be zero.
                Duration::from_secs_f64(total).max(Duration::from_nanos(1))
            });
        });
        group.finish();
        // `fastest` is infinite if the benchmark is not selected.
        let rates = self.table.entry(format!("{kernel}/{variant}")).or_default();
        rates.resize(self.number, f64::NAN);
        rates.push(units as f64 / fastest / 1e6);
    }
}
