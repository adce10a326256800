//! Flows whose answer is known, run on the device of the user, judged against published limits.
//!
//! A case is a function that runs flows on a [`Stand`] and returns [`Record`]s: a number, what it
//! should be, the error, the limit and the cost. Cases are named `family/case`, one family a file.
//! The short form fits a CPU adapter of two cores within minutes; `--full` adds the fine grids and
//! long runs. Flows are in lattice units: cell, step and density of the fluid are 1. Dry blocks, in SI,
//! run on the host.

pub mod fields;
pub mod method;
pub mod record;
pub mod stand;
pub mod stopwatch;

pub(crate) mod cavity;
mod conservation;
mod dda;
pub(crate) mod decay;
mod golden;
mod null_models;
mod offset_joint;
mod open_channel;
mod outlet;
pub(crate) mod plane_walls;
mod repeatability;
pub(crate) mod rock;
mod rock_broadphase;
mod rock_contact;
mod rock_free_body;
mod rock_incline;
mod rock_rebound;
mod rock_rest;
mod rock_toppling;
mod rock_wedge;
mod shear_wave;
mod slots;
pub(crate) mod solids;
mod stability;
mod turbulent_channel;
mod wake;
mod wale;
pub(crate) mod water;

pub use method::Method;
pub use record::{Record, Trial};
pub use stand::{Flow, Stand};

use crate::bench::Machine;
use anyhow::Context;
use serde::Serialize;
use std::path::PathBuf;

/// Compares flows with exact solutions, published tables and float64 references.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct Args {
    /// Cases to run, such as `cavity/*`; all without it
    #[arg(long, value_name = "GLOB")]
    pub case: Option<String>,
    /// Finer grids, longer runs, and the cases that need them
    #[arg(long)]
    pub full: bool,
    /// Where to write the records as a JSON array
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Directory for pictures of what cases found
    #[arg(long, value_name = "DIR")]
    pub pictures: Option<PathBuf>,
    /// Part of the name of the adapter to use
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
}

/// What a case returns: its records, without its name.
type Outcome = anyhow::Result<Vec<Record>>;

/// A named case.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Family and case, as `--case` matches them.
    pub name: &'static str,
    /// Whether it only runs with `--full`.
    pub only_full: bool,
    run: fn(&Stand) -> Outcome,
}

const fn short(name: &'static str, run: fn(&Stand) -> Outcome) -> Case {
    Case {
        name,
        only_full: false,
        run,
    }
}

const fn long(name: &'static str, run: fn(&Stand) -> Outcome) -> Case {
    Case {
        name,
        only_full: true,
        run,
    }
}

/// All cases, in the order in which they run.
pub const CASES: &[Case] = &[
    short("kernels/slots", slots::run),
    short("kernels/golden", golden::run),
    short("kernels/null-models", null_models::run),
    short("kernels/repeatability", repeatability::run),
    short("kernels/conservation", conservation::run),
    short("taylor-green/convergence", decay::taylor_green),
    short("abc-flow/convergence", decay::abc_flow),
    short("shear-wave/galilean", shear_wave::run),
    short("walls/couette", plane_walls::couette),
    short("walls/poiseuille", plane_walls::poiseuille),
    short("walls/film", plane_walls::film),
    short("channel/velocity-pressure", open_channel::velocity_pressure),
    short("channel/velocity-outflow", open_channel::velocity_outflow),
    short("channel/pressure-pressure", open_channel::pressure_pressure),
    short("wake/pressure", wake::pressure),
    short("wake/outflow", wake::outflow),
    short("cavity/re100", cavity::re100),
    long("cavity/re1000", cavity::re1000),
    short("wale/pure-shear", wale::pure_shear),
    short("wale/near-wall", wale::near_wall),
    short("wale/solid-rotation", wale::solid_rotation),
    long("wale/channel-re-tau-180", turbulent_channel::run),
    long("joint/stagnation", offset_joint::stagnation),
    short("outlet/pulse", outlet::pulse),
    short("stability/quiescent", stability::quiescent),
    short("stability/taylor-green", stability::taylor_green),
    short("solids/volume", solids::volume::run),
    short("solids/plates", solids::plates::run),
    short("solids/array", solids::array::drag),
    long("solids/array-offset", solids::array::offset),
    short("solids/array-comparison", solids::array::comparison),
    short("solids/array-map", solids::array::map),
    short("solids/rotation", solids::rotation::run),
    short("solids/release", solids::release::run),
    short("solids/buoyancy", solids::buoyancy::archimedes),
    short("solids/neutral", solids::buoyancy::neutral),
    short("solids/crossing", solids::crossing::run),
    short("solids/spike", solids::spike::run),
    short("solids/momentum", solids::momentum::run),
    short("solids/lubrication", solids::lubrication::run),
    short("solids/landing", solids::lubrication::landing),
    short("solids/settling", solids::settling::short),
    long("solids/settling-whole", solids::settling::whole),
    short("solids/cylinder", solids::cylinder::run),
    long("solids/sphere", solids::obstacle::sphere),
    long("solids/cube", solids::obstacle::cube),
    long("solids/incline-flow", solids::incline_flow::run),
    short("rock/incline", rock_incline::run),
    short("rock/toppling", rock_toppling::run),
    short("rock/rebound", rock_rebound::run),
    short("rock/free-body", rock_free_body::run),
    short("rock/wedge", rock_wedge::run),
    short("rock/stack", rock_rest::stack),
    short("rock/pyramid", rock_rest::pyramid),
    short("rock/arch", rock_rest::arch),
    short("rock/contact-sign", rock_contact::sign),
    short("rock/broadphase", rock_broadphase::run),
    short("dda/critical-step", dda::critical_step::run),
    short("dda/spin", dda::spin::run),
    short("dda/vibration", dda::vibration::run),
    short("dda/bar", dda::bar::run),
    short("dda/stack", dda::contact::stack),
    short("dda/collision", dda::contact::collision),
    short("dda/rigid-limit", dda::rigid_limit::run),
    short("water/still", water::still::run),
    short("water/film", water::film::run),
    short("water/submerged", water::buoyancy::submerged),
    short("water/stacked", water::buoyancy::stacked),
    short("water/floating", water::buoyancy::floating),
    short("water/standing-wave", water::wave::run),
    short("water/dam-break", water::dam::run),
    short("water/wave-maker", water::maker::run),
    short("water/pushed", water::pushed::run),
    long("water/solitary", water::solitary::run),
    long("water/schemes", water::schemes::run),
];

/// The cases whose names match.
///
/// # Errors
/// If the pattern is not one, or no case matches: the names there are.
pub fn select(pattern: Option<&str>) -> anyhow::Result<Vec<Case>> {
    let pattern = glob::Pattern::new(pattern.unwrap_or("*"))
        .with_context(|| format!("--case {} is no pattern", pattern.unwrap_or_default()))?;
    let found: Vec<_> = CASES
        .iter()
        .filter(|case| pattern.matches(case.name))
        .copied()
        .collect();
    if found.is_empty() {
        let names: Vec<_> = CASES.iter().map(|case| case.name).collect();
        anyhow::bail!(
            "no case matches --case {pattern}; there are: {}",
            names.join(", ")
        );
    }
    Ok(found)
}

/// Runs the cases that match, prints each record as its case ends; whether all passed.
///
/// # Errors
/// If no case matches, there is no adapter, or the JSON file cannot be written. A case that breaks
/// off does not end the others: it fails with what went wrong.
pub fn run(args: Args) -> anyhow::Result<bool> {
    let cases = select(args.case.as_deref())?;
    let mut stand = Stand::open(args.adapter.as_deref(), args.full)?;
    if let Some(folder) = &args.pictures {
        std::fs::create_dir_all(folder)
            .with_context(|| format!("cannot make {}", folder.display()))?;
    }
    stand.pictures = args.pictures;
    let mut records = Vec::new();
    println!("{}", record::header());
    for case in cases {
        println!("{}", case.name);
        if case.only_full && !args.full {
            println!("     left out, it runs with --full");
            continue;
        }
        let mut found = (case.run)(&stand).unwrap_or_else(|error| vec![broken_off(&error)]);
        for record in &mut found {
            record.case = case.name.into();
            println!("{}", record::row(record));
        }
        records.append(&mut found);
    }
    if let Some(path) = &args.json {
        let machine = Machine::of(&stand.device.adapter_info());
        let kept: Vec<_> = records
            .iter()
            .map(|record| Kept {
                record,
                machine: &machine,
            })
            .collect();
        let text = serde_json::to_string_pretty(&kept)?;
        std::fs::write(path, text + "\n")
            .with_context(|| format!("cannot write {}", path.display()))?;
    }
    let failed = records.iter().filter(|record| !record.passed).count();
    let judged = records.iter().filter(|r| r.limit.is_some()).count();
    println!("{} of {judged} checks passed", judged - failed);
    Ok(failed == 0)
}

/// A record as it is kept: with where and when it was found.
#[derive(Serialize)]
struct Kept<'a> {
    #[serde(flatten)]
    record: &'a Record,
    #[serde(flatten)]
    machine: &'a Machine,
}

/// The record of a case that could not finish.
fn broken_off(error: &anyhow::Error) -> Record {
    let trial = Trial {
        setup: format!("{error:#}"),
        ..Trial::default()
    };
    trial.at_least("runs to its end", 0.0, 1.0)
}
