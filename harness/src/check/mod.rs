//! `riprap check`: cells, memory, kernels and expected running time of a scene.

mod accuracy;
mod blocks;
mod dry;
mod kernels;
mod lines;
mod report;
mod trial;
mod water;

pub use accuracy::Accuracy;
pub use blocks::{BlockFacts, Immersion, Narrow};
pub use dry::RockReport;
pub use report::Report;
pub use water::WaterReport;

use crate::{adapters::Adapter, gpu, print, run::SceneRun};
use anyhow::Result;
use riprap::{scene::Scene, simulation::Kind};
use serde::Serialize;
use std::path::PathBuf;
use trial::Trial;

/// Shows what a scene will run and how long it will take; computes a few steps of it.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Scene, a TOML file.
    scene: PathBuf,
    /// Part of the name of the adapter; see `riprap adapters`.
    #[arg(long)]
    adapter: Option<String>,
    /// Print JSON; numbers are in SI, sizes in bytes.
    #[arg(long)]
    json: bool,
    /// Write the linked WGSL of each kernel of the fluid to this folder.
    #[arg(long, value_name = "DIR")]
    kernels: Option<PathBuf>,
}

/// Prints the report.
pub fn run(args: &Args) -> Result<()> {
    let scene = Scene::from_file(&args.scene)?;
    let name = args.adapter.as_deref();
    let mut run = SceneRun::open(&scene, &args.scene, name)?;
    // An error that ends the trial is returned after the report.
    let ended = match run.simulation.kind() {
        Kind::Rock => {
            let report = dry::report(&mut run)?;
            show(args, &report, RockReport::text)?;
            Ok(())
        }
        Kind::Particles => {
            let adapter = Adapter::of(&gpu::pick(name)?, name.is_none());
            let (report, ended) = water::report(&mut run, adapter);
            report.map_or(Ok(()), |report| show(args, &report, WaterReport::text))?;
            ended
        }
        Kind::Lattice => {
            let adapter = Adapter::of(&gpu::pick(name)?, name.is_none());
            let trial = Trial::of(&mut run);
            if let Some(lattice) = run.lattice() {
                let report = Report::of(&run.simulation, lattice, adapter, &trial)?;
                show(args, &report, Report::text)?;
            }
            trial.ended
        }
    };
    if let Some(folder) = &args.kernels {
        kernels::write(folder, &run.simulation)?;
    }
    Ok(ended?)
}

/// Prints a report as text or JSON.
fn show<T: Serialize>(args: &Args, report: &T, text: impl Fn(&T) -> String) -> Result<()> {
    if args.json {
        print::print_json(report)
    } else {
        print::print(&text(report))
    }
}
