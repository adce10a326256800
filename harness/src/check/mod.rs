//! `riprap check`: what a scene will run, and how long it will take.

mod report;
mod rock;
mod text;
mod trial;

pub use report::Report;
pub use rock::RockReport;

use crate::{adapters::Adapter, gpu, print};
use anyhow::Result;
use riprap::{
    scene::Scene,
    simulation::{Needs, Simulation},
};
use std::path::PathBuf;

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
}

/// Prints the report.
///
/// # Errors
/// What the scene lacks, or what the adapter cannot hold.
pub fn run(args: &Args) -> Result<()> {
    let scene = Scene::from_file(&args.scene)?;
    if scene.has_blocks() {
        let report = rock::report(&scene, &args.scene, args.adapter.as_deref())?;
        return if args.json {
            print::print_json(&report)
        } else {
            print::print(&report.text())
        };
    }
    let adapter = gpu::pick(args.adapter.as_deref())?;
    let needs = Needs::of(&scene, &adapter)?;
    let (device, queue) = gpu::open(&adapter, needs.features, needs.limits.clone())?;
    let made = Simulation::new(&device, &queue, &scene);
    let mut simulation = gpu::drive(&device, trial::PATIENCE, "compiling the kernels", made)??;
    let report = Report {
        time: trial::time(&mut simulation, &device)?,
        ..Report::of(&simulation, Adapter::of(&adapter, args.adapter.is_none()))?
    };
    if args.json {
        print::print_json(&report)
    } else {
        print::print(&report.text())
    }
}
