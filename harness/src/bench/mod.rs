//! `riprap bench`: speed of each variant of the fluid kernel compared with the memory bandwidth, of rock contacts and steps, and
//! of water particles; cost of solids in the fluid and of unused features, which should be zero; or one record of a GPU.

mod device;
mod fluid;
mod machine;
pub mod rock;
mod solids;
mod table;
mod target;
mod unused;
mod water;
mod work;

pub use fluid::storage;
pub use kit::copy::copy_bandwidth;
pub use machine::Machine;
pub use work::Work;

use kit::{clock::Clock, gpu};
use riprap::wgpu;
use serde::Serialize;
use std::path::PathBuf;
use target::Target;

/// Measures the speed of the fluid, the blocks and the particles, and the cost of solids and of unused features.
#[derive(clap::Args, Clone, Debug)]
pub struct Args {
    /// Write the results as a JSON array
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Adapter whose description contains NAME [default: the first of `riprap adapters`]
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
    /// Only one part [default: all]
    #[arg(long, value_name = "PART")]
    pub only: Option<Part>,
    /// Only the main kernels, on 64³ cells, and at most 1000 blocks, for a short time
    #[arg(long)]
    pub quick: bool,
    /// Piles of up to 100 000 blocks and a million particles; takes many minutes
    #[arg(long, conflicts_with = "quick")]
    pub full: bool,
    /// Cells per axis; may be repeated [default: 64, 96, 128 and, if that takes only seconds, 256]
    #[arg(long, value_name = "N")]
    pub grid: Vec<u32>,
    /// Only the whole table: f32 and 16 bits, plain, with WALE and with moving solids, on 128³ to 512³ cells, as far as memory
    /// and fifteen seconds per row allow
    #[arg(long, conflicts_with_all = ["only", "quick", "full", "grid"])]
    pub all: bool,
    /// One record of a GPU, in less than four minutes: the table on 128³ and 256³ cells, the number of blocks from which the
    /// device finds pairs faster than the host, and the short cases of `validate` that use the device
    #[arg(long, conflicts_with_all = ["only", "quick", "full", "grid", "all"])]
    pub device: bool,
    /// GiB that the fluids of a group may take together [default: 6, or half of the free memory on a software adapter]
    #[arg(long, value_name = "GIB")]
    pub memory: Option<f64>,
}

/// Parts of the benchmark.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The lattice.
    Fluid,
    /// The blocks.
    Rock,
    /// The particles.
    Water,
    /// The solids in the fluid.
    Solids,
    /// Unused features, which should cost nothing, and the scaling of the cost of moving blocks.
    Unused,
}

/// The device of a benchmark, and its extent.
#[derive(Clone, Copy, Debug)]
pub struct Bench<'a> {
    /// The device.
    pub device: &'a wgpu::Device,
    /// Its queue.
    pub queue: &'a wgpu::Queue,
    /// Machine and time of the measurement.
    pub machine: &'a Machine,
    /// Only the main kernels, for a short time.
    pub quick: bool,
    /// Large sizes too.
    pub full: bool,
}

impl Bench<'_> {
    /// A clock for the device.
    fn clock(&self) -> Clock {
        Clock::new(self.device, self.queue, self.machine.software)
    }
}

/// A result of a part: one object of the file.
#[derive(Serialize)]
#[serde(untagged)]
enum Measured {
    Fluid(fluid::Row),
    Rock(rock::Row),
    Water(water::Row),
    Solids(solids::Row),
    Table(table::Row),
    Crossover(rock::Crossover),
    Validation(crate::validate::Record),
    LeftOut(device::SkippedCase),
    Target(Target),
}

/// Measures, prints a table as it goes, and writes the file.
pub fn run(args: Args) -> anyhow::Result<()> {
    let device = match gpu::pick(args.adapter.as_deref()) {
        Err(error) if args.only == Some(Part::Rock) && args.adapter.is_none() => {
            println!("{error}; pairs are found on the host only");
            None
        }
        adapter => {
            let adapter = adapter?;
            let wanted = wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::SHADER_INT64;
            let features = adapter.features() & wanted;
            let (device, queue) = gpu::open(&adapter, features, adapter.limits())?;
            Some((Machine::of(&adapter.get_info()), device, queue))
        }
    };
    let machine = match &device {
        Some((machine, ..)) => machine.clone(),
        None => Machine::host(),
    };
    println!("{machine}");
    let selected = |part| !args.all && !args.device && args.only.is_none_or(|only| only == part);
    let bench = device.as_ref().map(|(_, device, queue)| Bench {
        device,
        queue,
        machine: &machine,
        quick: args.quick,
        full: args.full,
    });
    let mut measured: Vec<Measured> = Vec::new();
    let mut targets = Vec::new();
    if let Some(bench) = &bench
        && selected(Part::Fluid)
    {
        let (rows, judged) = fluid::measure(&args, bench)?;
        targets.extend(judged);
        measured.extend(rows.into_iter().map(Measured::Fluid));
    }
    if selected(Part::Rock) {
        let plan = rock::Plan::new(args.quick, args.full);
        let (rows, judged) = rock::measure(&plan, bench.as_ref())?;
        targets.extend(judged);
        measured.extend(rows.into_iter().map(Measured::Rock));
    }
    if let Some(bench) = &bench {
        if selected(Part::Water) {
            measured.extend(water::measure(bench)?.into_iter().map(Measured::Water));
        }
        if selected(Part::Solids) {
            let (rows, judged) = solids::measure(bench)?;
            targets.extend(judged);
            measured.extend(rows.into_iter().map(Measured::Solids));
        }
        if selected(Part::Unused) {
            let (rows, judged) = unused::measure(bench)?;
            targets.extend(judged);
            measured.extend(rows.into_iter().map(Measured::Solids));
        }
        if args.all || args.device {
            // A GPU reports by itself when it runs out of memory.
            let limited = machine.software || args.memory.is_some();
            let most = limited.then(|| budget(args.memory, machine.software));
            measured.extend(match args.device {
                true => device::measure(bench, most)?,
                false => {
                    let rows = table::measure(bench, most, table::Extent::ALL)?;
                    rows.into_iter().map(Measured::Table).collect()
                }
            });
        }
    }
    measured.extend(targets.into_iter().map(Measured::Target));
    if let Some(path) = &args.json {
        let text = machine.json(measured)?;
        std::fs::write(path, text).map_err(|e| riprap::Error::file(path, e))?;
    }
    Ok(())
}

/// Median of some values.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Bytes that one group of fluids may take.
fn budget(gib: Option<f64>, software: bool) -> u64 {
    const GIB: f64 = (1u64 << 30) as f64;
    let free = || {
        let text = std::fs::read_to_string("/proc/meminfo").ok()?;
        let mut lines = text.lines();
        let line = lines.find(|line| line.starts_with("MemAvailable:"))?;
        let kib: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
        Some(0.5 * kib * 1024.0)
    };
    // wgpu does not report the memory of a GPU; small ones have 6 GiB.
    let default = 6.0 * GIB;
    let bytes = match gib {
        Some(gib) => gib * GIB,
        None if software => free().unwrap_or(default).min(default),
        None => default,
    };
    bytes as u64
}
