//! `riprap bench`: how fast each form of the kernel is, beside what memory allows.

mod clock;
mod copy;
mod flow;
mod group;
mod report;
mod subject;
mod targets;
mod variant;

pub use copy::copy_bandwidth;

use crate::gpu;
use clock::Clock;
use report::{Machine, Row};
use riprap::wgpu;
use std::path::PathBuf;

/// What to measure, and on what.
#[derive(clap::Args, Clone, Debug)]
pub struct Args {
    /// Write the results as a JSON array
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Adapter whose description contains NAME [default: the first of `riprap adapters`]
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
    /// Only the main kernels, on 64³ cells, for a short time
    #[arg(long)]
    pub quick: bool,
    /// Cells an axis; may be repeated [default: 64, 96, 128 and, where that takes seconds, 256]
    #[arg(long, value_name = "N")]
    pub grid: Vec<u32>,
    /// GiB that the fluids measured side by side may take together [default: 6, or half of what
    /// is free on a software adapter]
    #[arg(long, value_name = "GIB")]
    pub memory: Option<f64>,
}

/// Measures, prints a table as it goes, and writes the file.
///
/// # Errors
/// If there is no adapter, the device fails, or the file cannot be written.
pub fn run(args: Args) -> anyhow::Result<()> {
    let adapter = gpu::pick(args.adapter.as_deref())?;
    let wanted = wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::SHADER_INT64;
    let (device, queue) = gpu::open(&adapter, adapter.features() & wanted, adapter.limits())?;
    let machine = Machine::of(&adapter.get_info());
    println!("{machine}");
    let mut clock = Clock::new(&device, &queue, machine.software);
    let budget = budget(args.memory, machine.software);
    let mut rows: Vec<Row> = Vec::new();
    for grid in grids(&args) {
        if let Some(why) = too_slow(&args, grid, &rows) {
            println!("\n{grid}³: left out, {why}");
            continue;
        }
        println!("\n{grid}³ cells\n{}", report::HEAD);
        for group in variant::groups(grid, &machine, args.quick, budget, &device) {
            rows.extend(group::measure(&mut clock, &machine, group, args.quick)?);
        }
        targets::print(grid, &rows, machine.software);
    }
    if let Some(path) = &args.json {
        let text = serde_json::to_string_pretty(&rows)?;
        std::fs::write(path, text + "\n").map_err(|e| riprap::Error::file(path, e))?;
    }
    Ok(())
}

fn grids(args: &Args) -> Vec<u32> {
    match (&args.grid[..], args.quick) {
        ([], true) => vec![64],
        ([], false) => vec![64, 96, 128, 256],
        (given, _) => given.to_vec(),
    }
}

/// Bytes that one group of fluids may take.
fn budget(gib: Option<f64>, software: bool) -> u64 {
    const GIB: f64 = (1u64 << 30) as f64;
    let free = || {
        let text = std::fs::read_to_string("/proc/meminfo").ok()?;
        let line = text
            .lines()
            .find(|line| line.starts_with("MemAvailable:"))?;
        let kib: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
        Some(0.5 * kib * 1024.0)
    };
    // wgpu does not say what a GPU holds; 6 GiB is what small ones have.
    let default = 6.0 * GIB;
    let bytes = match gib {
        Some(gib) => gib * GIB,
        None if software => free().unwrap_or(default).min(default),
        None => default,
    };
    bytes as u64
}

/// Why a grid that nobody asked for takes too long, from the speed on the grids before.
fn too_slow(args: &Args, grid: u32, rows: &[Row]) -> Option<String> {
    // A group takes tens of steps: 0.2 s each are seconds.
    const PATIENCE: f64 = 0.2;
    let last = rows
        .iter()
        .rev()
        .find(|row| row.variant == variant::PLAIN)?;
    let seconds = f64::from(grid).powi(3) / (last.mlups_wall * 1e6);
    (args.grid.is_empty() && seconds > PATIENCE)
        .then(|| format!("a step would take {seconds:.1} s; ask for it by --grid {grid}"))
}
