//! `riprap threshold`: the value of a number in a scene at which a block moves for the first time.
//!
//! A formula in place of the number is multiplied by the value. Each trial runs the scene with another value until a block moves
//! or the scene ends. The next trial takes the middle between a value at which no block moves and one at which a block does.

mod bracket;
mod equilibrium;
mod key;
mod report;
mod trial;

pub use bracket::Bracket;
pub use equilibrium::Equilibrium;
pub(crate) use equilibrium::mean_and_error;
pub use key::Key;
pub use report::Report;
pub use trial::{Motion, Trial};

use crate::run::SceneRun;
use anyhow::{Context, Result, bail};
use riprap::{Error, scene::Scene};
use std::{
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
};

/// Finds the value of a number of a scene at which a block moves for the first time, by bisection.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct Args {
    /// The scene, a TOML file
    pub scene: PathBuf,
    /// Key of the number in the scene, such as `boundaries.x_min.velocity[0]` or `materials.rock.friction`; several times for
    /// numbers that have the same value. If the scene has a formula there, it is multiplied by the value: A, B and T are then factors
    #[arg(long, required = true, value_name = "KEY")]
    pub key: Vec<String>,
    /// Value at which no block moves
    #[arg(long, value_name = "A", allow_negative_numbers = true)]
    pub from: f64,
    /// Value at which a block moves
    #[arg(long, value_name = "B", allow_negative_numbers = true)]
    pub to: f64,
    /// Largest distance of the two values at the end
    #[arg(long, value_name = "T")]
    pub tolerance: f64,
    /// Only the motion of this block counts [default: that of every free block]
    #[arg(long, value_name = "NAME")]
    pub block: Option<String>,
    /// A block has moved when its centroid is this far, m, from its initial position [default: 1 % of its size, the cube root of
    /// its volume]
    #[arg(long, value_name = "M")]
    pub distance: Option<f64>,
    /// Instead of --distance: a block has moved when its centroid is as fast as this, m/s
    #[arg(long, value_name = "V", conflicts_with = "distance")]
    pub speed: Option<f64>,
    /// Also report the value at which a block fails according to block theory: a factor of safety is one under the mean loads of
    /// the last trial in which no block moved, if the loads of the flow grow with the square of the value. For velocities
    #[arg(long)]
    pub equilibrium: bool,
    /// Start every trial from the state after so many seconds at the value --from
    #[arg(long, value_name = "S")]
    pub settle: Option<f64>,
    /// Time steps of a trial [default: those of the scene's run]
    #[arg(long, value_name = "N")]
    pub steps: Option<u64>,
    /// Folder for the results [default: out/ and the name of the scene, with _threshold]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Part of the name of the adapter to compute on [default: the first GPU, else a CPU]
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
    /// Print the result as JSON
    #[arg(long)]
    pub json: bool,
}

/// Bisects until the values are close enough, or until `stop` is set.
pub fn run(args: &Args, stop: &AtomicBool) -> Result<Report> {
    let text = std::fs::read_to_string(&args.scene).map_err(|error| {
        let message = format!("cannot read the scene: {error}; check the path");
        Error::file(&args.scene, message)
    })?;
    // Errors in the file itself are reported with their line.
    let scene = Scene::from_file(&args.scene)?;
    let keys: Vec<Key> = args
        .key
        .iter()
        .map(|key| Key::parse(key))
        .collect::<riprap::Result<_>>()?;
    if args.equilibrium && scene.has_fluid() {
        keys.iter().try_for_each(Key::check_velocity)?;
    }
    let table: toml::Table = toml::from_str(&text).map_err(|e| Error::file(&args.scene, e))?;
    let open = |value: f64| -> riprap::Result<SceneRun> {
        let mut table = table.clone();
        for key in &keys {
            key.set(&mut table, value)?;
        }
        let dir = args.scene.parent().unwrap_or(Path::new(""));
        let place = format!("{} with {value}", args.scene.display());
        let scene = Scene::from_toml(&table.to_string(), dir, &place)?;
        SceneRun::open(&scene, &args.scene, args.adapter.as_deref())
    };
    let folder = args.out.clone().unwrap_or_else(|| {
        let stem = args.scene.file_stem().unwrap_or("scene".as_ref());
        let mut name = stem.to_os_string();
        name.push("_threshold");
        Path::new("out").join(name)
    });
    std::fs::create_dir_all(&folder).map_err(|error| {
        let message = format!("cannot make this folder: {error}; choose another one with `--out`");
        Error::file(&folder, message)
    })?;
    let mut bracket = Bracket::new(args.from, args.to, args.tolerance)?;
    let mut report = Report::new(args);
    let settled = args
        .settle
        .map(|time| (time, folder.join("settled.riprap")));
    if let Some((time, path)) = &settled {
        let start = open(args.from)?;
        trial::check_settled(&start, &open(args.to)?, &keys)?;
        trial::settle(start, *time, path)
            .with_context(|| format!("while the blocks settled at {}", args.from))?;
    }
    let settled = settled.as_ref().map(|(_, path)| path.as_path());
    while let Some(value) = bracket.next() {
        let trial = trial::run(open(value)?, value, args, settled, stop)
            .with_context(|| format!("in the trial with the value {value}"))?;
        let Some(trial) = trial else {
            break;
        };
        eprintln!("{trial}");
        let moved = trial.moved.is_some();
        let told = trial.to_string();
        report.trials.push(trial);
        report.write(&folder)?;
        if let Err(wrong) = bracket.take(value, moved) {
            let message = format!("{wrong} ({told})");
            bail!(Error::argument(args.key.join(", "), message));
        }
    }
    report.end(bracket.found(), bracket.is_narrow());
    report.write(&folder)?;
    Ok(report)
}
