//! `riprap check`: what a scene will run, and how long it will take.

mod accuracy;
mod blocks;
mod coupling;
mod dry;
mod kernels;
mod report;
mod text;
mod trial;
mod water;

pub use accuracy::Accuracy;
pub use blocks::BlockFacts;
pub use coupling::{Immersion, Narrow};
pub use dry::RockReport;
pub use report::Report;
pub use water::WaterReport;

use crate::{adapters::Adapter, gpu, print, search::located};
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
    /// Write the linked WGSL of each kernel of the fluid to this folder.
    #[arg(long, value_name = "DIR")]
    kernels: Option<PathBuf>,
}

/// Prints the report.
///
/// # Errors
/// What the scene lacks, or what the adapter cannot hold.
pub fn run(args: &Args) -> Result<()> {
    let scene = Scene::from_file(&args.scene)?;
    if scene.has_particles() {
        let (report, ended) = water::report(
            &scene,
            &args.scene,
            args.adapter.as_deref(),
            args.kernels.as_deref(),
        )?;
        if args.json {
            print::print_json(&report)?;
        } else {
            print::print(&report.text())?;
        }
        // What the trial met is told after all that was known before it.
        return Ok(ended?);
    }
    if !scene.has_fluid() {
        if args.kernels.is_some() {
            let message = "the scene has no fluid, so that there are no kernels to write";
            return Err(riprap::Error::argument("--kernels", message).into());
        }
        let report = dry::report(&scene, &args.scene, args.adapter.as_deref())?;
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
    let made = gpu::drive(&device, trial::PATIENCE, "compiling the kernels", made)?;
    let mut simulation = made.map_err(|error| located(error, &args.scene))?;
    let (time, ended) = trial::time(&mut simulation, &device);
    if let Some(folder) = &args.kernels {
        kernels::write_lattice(folder, simulation.lattice(), simulation.coupled())?;
    }
    let adapter = Adapter::of(&adapter, args.adapter.is_none());
    let report = Report::of(&simulation, adapter, time)?;
    if args.json {
        print::print_json(&report)?;
    } else {
        print::print(&report.text())?;
    }
    // What the trial met is told after all that was known before it.
    Ok(ended?)
}
