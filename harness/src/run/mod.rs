//! `riprap run`: runs a scene and writes the requested output.
//!
//! `SceneRun` is a scene on a device, and `Runner` takes it to its end. Everything that a run writes is a `Recorder` with
//! a schedule. The scene advances in batches that end when the next recorder is due. On Ctrl-C, at the end, and when
//! the flow diverges, the files on disk are complete and the run can be continued.

mod checkpoints;
mod collection;
mod estimate;
mod extremes;
mod gauges;
mod header;
mod history;
mod lattice;
mod progress;
mod recorder;
mod rock;
mod runner;
mod scene_run;
mod skipped_work;
mod slices;
mod statistics;
mod summary;
mod table;
mod throughput;
mod views;
mod wall_units;
mod walls;
mod water;

pub(crate) use scene_run::SceneRun;
pub(crate) use throughput::Batch;

pub use estimate::{Estimate, Headline};
pub use lattice::{Coupling, LatticeSummary};
pub use recorder::Schedule;
pub use rock::{Factors, Rock, Rocks, Safety, block_probe::fluid_wrench};
pub use skipped_work::SkippedWork;
pub use statistics::UntilError;
pub use summary::{Summary, Unfinished};
pub use water::WaterSummary;

use anyhow::Result;
use riprap::{Error, scene::Scene};
use runner::Runner;
use std::{
    fs::{File, TryLockError},
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
};

/// Runs a scene and writes fields, pictures, tables, checkpoints and a summary.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct Args {
    /// The scene, a TOML file
    pub scene: PathBuf,
    /// Folder of the output [default: out/ and the name of the scene]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Part of the name of the adapter to compute on [default: the first GPU, else a CPU]
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
    /// Time step at which the run ends, counted from the start of the scene [default: the scene's]
    #[arg(long, value_name = "N")]
    pub steps: Option<u64>,
    /// Continue from a checkpoint of this scene; tables and collections in the folder are continued
    #[arg(long, value_name = "FILE")]
    pub restart: Option<PathBuf>,
    /// Print the summary as JSON
    #[arg(long)]
    pub json: bool,
    /// Run the scene first at half its resolution, and report how much the means of probes and histories differ: an eighth
    /// of the cells or particles, a sixteenth of the time; for dry rock, steps twice as long
    #[arg(long)]
    pub error_estimate: bool,
    /// End the run early, once the statistical errors of the means of all probes with statistics, relative to their root mean
    /// squares, are at most ERROR: `2%` or `0.02`; not before 256 samples that span as long a time as that before statistics.from
    #[arg(long, value_name = "ERROR")]
    pub until_error: Option<UntilError>,
    /// Limit --until-error to these probes, or to quantities of them such as `point.velocity`
    #[arg(
        long,
        value_name = "NAME",
        requires = "until_error",
        value_delimiter = ','
    )]
    pub error_of: Vec<String>,
    /// Print the times of the phases of steps at the end: passes on the device if it has timestamps, and the host
    #[arg(long)]
    pub timings: bool,
}

/// Runs a scene until its end, or until `stop` is set.
///
/// A flow that diverges is no error here: the summary reports it and what is on disk.
pub fn run(args: &Args, stop: &AtomicBool) -> Result<Summary> {
    let scene = Scene::from_file(&args.scene)?;
    match args.error_estimate {
        true => estimate::run(&scene, args, stop),
        false => computed(&scene, args, stop),
    }
}

/// Runs a scene that has been read, from its start or from the checkpoint to the end.
fn computed(scene: &Scene, args: &Args, stop: &AtomicBool) -> Result<Summary> {
    let mut run = SceneRun::open(scene, &args.scene, args.adapter.as_deref())?;
    let folder = folder(args);
    if args.steps == Some(0) {
        let message = "a run has at least one; `riprap check` examines a scene without running it";
        return Err(Error::argument("--steps 0", message).into());
    }
    let text = std::fs::read_to_string(&args.scene).unwrap_or_default();
    if let Some(path) = &args.restart {
        run.restore(path)
            .map_err(|error| checkpoints::with_differences(error, path, &text))?;
    }
    let last = args
        .steps
        .unwrap_or_else(|| run.scene().run.count(run.time_step()))
        .max(1);
    if args.restart.is_some() {
        let done = run.step();
        if done >= last {
            return Err(Error::argument(
                "restart",
                format!(
                    "the checkpoint is of step {done} and the run ends at step {last}; give \
                     `--steps` a larger number, or the scene a longer run"
                ),
            )
            .into());
        }
    }
    std::fs::create_dir_all(&folder).map_err(|error| {
        let message = format!("cannot make this folder: {error}; choose another one with `--out`");
        Error::file(&folder, message)
    })?;
    let _locked = locked(&folder)?;
    let restart = args.restart.as_deref();
    if let Some(path) = restart {
        checkpoints::check_order(path, &text)?;
    }
    let warnings = restart.into_iter().flat_map(|path| {
        let tables = checkpoints::other_tables(path, &folder, &text);
        checkpoints::other_scene(path, &text)
            .into_iter()
            .chain(tables)
    });
    let warnings: Vec<String> = warnings.collect();
    let mut runner = Runner::new(&mut run, &folder, last, restart, &text)?;
    if let Some(until) = args.until_error {
        runner.stop_at_error(until, &args.error_of, scene)?;
    }
    runner.summary.scene = args.scene.display().to_string();
    runner.print_header(&run);
    for warning in warnings {
        eprintln!("warning: {warning}");
        runner.summary.warnings.push(warning);
    }
    if args.timings {
        run.simulation.time_phases();
    }
    let summary = runner.run_to_end(&mut run, stop)?;
    if args.timings {
        eprint!("{}", throughput::phase_table(&run.simulation.phases()));
    }
    Ok(summary)
}

/// The output folder, locked until the end of a run; `None` where the system locks no folders.
fn locked(folder: &Path) -> Result<Option<File>> {
    let Ok(opened) = File::open(folder) else {
        return Ok(None);
    };
    match opened.try_lock() {
        Ok(()) => Ok(Some(opened)),
        Err(TryLockError::WouldBlock) => {
            let message = "another run writes to this folder; choose another one with `--out`";
            Err(Error::file(folder, message).into())
        }
        Err(TryLockError::Error(_)) => Ok(None),
    }
}

/// The output folder of a run.
fn folder(args: &Args) -> PathBuf {
    args.out.clone().unwrap_or_else(|| {
        let stem = args.scene.file_stem().unwrap_or("scene".as_ref());
        Path::new("out").join(stem)
    })
}
