//! `riprap stress`: maps of where the methods hold and where they end, each run to its end or to the error that
//! ends it.
//!
//! A map is a function that runs one cell after the other and hands each to a [`Sink`], which has it on disk before
//! the next begins. The short form has coarse axes and short runs, and says so; `--full` has the whole.

mod cell;
mod density;
mod long;
mod maps;
mod packed;
mod places;
mod restarts;
mod shear_layer;
mod sink;
mod stiffness;
mod tally;

pub use cell::{Cell, Outcome};
pub use maps::{MAPS, Map};
pub use sink::Sink;

use crate::{bench::Machine, validate::Stand};
use riprap::scene::Advice;
use std::{path::PathBuf, time::Instant};

/// Maps where the methods are stable, and tries what may break them; writes stress.csv, stress.json and a picture of
/// each map.
///
/// The short form takes six minutes on two quiet cores, with coarse axes and short runs. A stress that is killed
/// keeps every cell that it has finished.
#[derive(Clone, Debug, clap::Args)]
pub struct Args {
    /// Fine axes and long runs; takes hours on a CPU
    #[arg(long)]
    pub full: bool,
    /// Only this map
    #[arg(long, value_name = "NAME", value_parser = maps::names())]
    pub only: Option<String>,
    /// Folder for what is written
    #[arg(long, value_name = "DIR", default_value = "out/stress")]
    pub out: PathBuf,
    /// Part of the name of the adapter to use
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
}

/// Warnings, as [`Cell::warned`] has them.
fn warned(advice: &Advice) -> String {
    let places: Vec<_> = advice.iter().map(|warning| &*warning.place).collect();
    match places.is_empty() {
        true => String::new(),
        false => format!("warned {}", places.join(" ")),
    }
}

/// Bytes of two states that differ.
fn bytes_that_differ(a: &[u8], b: &[u8]) -> usize {
    let both = a.iter().zip(b).filter(|(a, b)| a != b);
    both.count() + a.len().abs_diff(b.len())
}

/// Draws the maps; whether no message was unclear and nothing that is judged missed its limit.
///
/// # Errors
/// If there is no adapter, or the files cannot be written.
pub fn run(args: &Args) -> anyhow::Result<bool> {
    let stand = Stand::open(args.adapter.as_deref(), args.full)?;
    let mut sink = Sink::begin(&args.out, Machine::of(&stand.device.adapter_info()))?;
    let begin = Instant::now();
    let wanted = |map: &&Map| args.only.as_ref().is_none_or(|only| only == map.name);
    for map in MAPS.iter().filter(wanted) {
        let before = Instant::now();
        println!("{}: {}", map.name, map.title);
        println!("  {}", map.extent(args.full));
        (map.run)(&stand, &mut sink)?;
        map.draw(&sink)?;
        for line in map.summary(&sink.of(map.name)) {
            println!("  {line}");
        }
        println!("  {:.0} s", before.elapsed().as_secs_f64());
    }
    let defects = sink.cells().iter().filter(|cell| cell.outcome.is_defect());
    let defects = defects.count();
    println!(
        "{} cells, {defects} defects, {:.0} s; in {}",
        sink.cells().len(),
        begin.elapsed().as_secs_f64(),
        sink.folder().display()
    );
    Ok(defects == 0)
}
