//! Validation: flows with a known solution, run on the user's device and judged against published limits.
//!
//! A case is a function that runs flows on a [`CaseContext`] and returns [`Record`]s: the value found, the expected value, the error,
//! the limit and the cost. Cases are named `family/case`, one file per family. The short form takes minutes on a CPU adapter with
//! two cores; `--full` adds the fine grids and long runs. Flows are in lattice units: cell, step and density of the fluid are 1.
//! Dry blocks, in SI, run on the host.

pub mod context;
pub mod fields;
pub mod method;
pub mod record;
pub mod tank;

pub(crate) mod cavity;
pub(crate) mod decay;
mod joint_pressure;
mod noise_and_shear;
mod offset_joint;
mod open_channel;
mod outlet;
pub(crate) mod plane_walls;
mod plucking;
mod repeatability;
pub(crate) mod rock;
mod separation;
mod slots;
mod stability;
mod statistics;
mod surfaces;
mod synthetic_turbulence;
mod wale;
mod wall_model;

/// Blocks in a fluid.
pub(crate) mod solids {
    pub mod array;
    pub mod buoyancy;
    pub mod conservation;
    pub mod crossing;
    pub mod cubes;
    pub mod cylinder;
    pub mod incline_flow;
    pub mod lubrication;
    pub mod obstacle;
    pub mod periodic_flow;
    pub mod plates;
    pub mod settling;
    pub mod sphere;
}

/// Free-surface water, by particles.
pub(crate) mod water {
    pub mod buoyancy;
    pub mod dam;
    pub mod film;
    pub mod maker;
    pub mod pushed;
    pub mod schemes;
    pub mod still;
    pub mod wave;
}

pub use context::{CaseContext, Flow};
pub use method::Method;
pub use record::{Record, Trial};

use crate::{bench::Machine, print};
use anyhow::Context;
use std::path::PathBuf;

/// Compares flows with exact solutions, published tables and float64 references.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct Args {
    /// Cases to run, such as `cavity/*` [default: all]
    #[arg(long, value_name = "GLOB")]
    pub case: Option<String>,
    /// Print the names of the cases, whether they need --full, and what they compute; run none
    #[arg(long)]
    pub list: bool,
    /// Finer grids, longer runs, and the cases that need them
    #[arg(long)]
    pub full: bool,
    /// Where to write the records as a JSON array
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Part of the name of the adapter to use
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
}

/// Result of a case: its records, not yet labelled with its name.
type Outcome = anyhow::Result<Vec<Record>>;

/// A named case.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Family and case, as `--case` matches them.
    pub name: &'static str,
    /// What the case computes, in one line.
    pub about: &'static str,
    /// Whether it only runs with `--full`.
    pub only_full: bool,
    run: fn(&CaseContext) -> Outcome,
}

const fn short(name: &'static str, about: &'static str, run: fn(&CaseContext) -> Outcome) -> Case {
    Case {
        name,
        about,
        only_full: false,
        run,
    }
}

const fn long(name: &'static str, about: &'static str, run: fn(&CaseContext) -> Outcome) -> Case {
    Case {
        name,
        about,
        only_full: true,
        run,
    }
}

/// All cases, in the order in which they run.
#[rustfmt::skip]
pub const CASES: &[Case] = &[
    short("kernels/slots", "every combination of slots is valid WGSL, and binds only what it uses", slots::run),
    short("kernels/golden", "a periodic box of noise and shear after 50 steps, against float64", noise_and_shear::golden),
    short("kernels/null-models", "a model with its constant at zero is the simpler model", noise_and_shear::null_models),
    short("kernels/repeatability", "same bits: twice, after a restart, in workgroups of other shapes", repeatability::run),
    short("kernels/conservation", "mass and momentum of a periodic box over 10⁴ steps", noise_and_shear::conservation),
    short("taylor-green/convergence", "order of convergence and viscosity of Taylor–Green vortices", decay::taylor_green),
    short("abc-flow/convergence", "order of convergence and viscosity of the ABC flow", decay::abc_flow),
    short("shear-wave/galilean", "a shear wave carried along an axis decays as one at rest", decay::shear_wave),
    short("walls/couette", "Couette flow between walls", plane_walls::couette),
    short("walls/poiseuille", "Poiseuille flow driven by a force", plane_walls::poiseuille),
    short("walls/film", "film with a slip top, driven by a force", plane_walls::film),
    short("channel/velocity-pressure", "channel from a velocity inlet to a held pressure", open_channel::velocity_pressure),
    short("channel/velocity-outflow", "channel from a velocity inlet to an outlet that lets vortices leave", open_channel::velocity_outflow),
    short("channel/pressure-pressure", "channel between two held pressures", open_channel::pressure_pressure),
    short("wake/pressure", "vortices behind a square cylinder cross a face of held pressure", outlet::wake_pressure),
    short("wake/outflow", "vortices behind a square cylinder cross an outlet that lets them leave", outlet::wake_outflow),
    short("cavity/re100", "lid-driven cavity at Re 100 (Ghia, Ghia & Shin 1982)", cavity::re100),
    long("cavity/re1000", "lid-driven cavity at Re 1000 (Ghia, Ghia & Shin 1982)", cavity::re1000),
    short("wale/pure-shear", "WALE has no eddy viscosity in pure shear", wale::pure_shear),
    short("wale/near-wall", "WALE's eddy viscosity grows as y³ at a wall", wale::near_wall),
    short("wale/solid-rotation", "WALE's eddy viscosity in solid rotation", wale::solid_rotation),
    short("wale/interval", "eddy viscosity evaluated every second step, against every step", wale::interval),
    long("wale/channel-re-tau-180", "turbulent channel at Re_τ 180 (Moser, Kim & Mansour 1999); needs a GPU", wale::turbulent_channel),
    short("wall-model/channel", "turbulent channels with a wall model (Lee & Moser 2015)", wall_model::channel),
    short("wall-model/rough-channel", "water over a rough bed, with a wall model (Keulegan 1938)", wall_model::rough_channel),
    long("wall-model/duct", "turbulent flow in a square duct, with a wall model (Prandtl 1935)", wall_model::duct),
    long("wall-model/blocks", "turbulent channel between plates that are blocks, with a wall model (Lee & Moser 2015)", wall_model::blocks),
    long("wall-model/rods", "stream along square rods at angles to the grid, with a wall model (Lee & Moser 2015)", wall_model::rods),
    long("wall-model/surfaces", "stream along rods with oblique exact surfaces, with a wall model (Lee & Moser 2015)", wall_model::surfaces),
    short("separation/laminar-step", "laminar flow behind a step (Erturk 2008)", separation::laminar_step),
    long("separation/step", "turbulent flow behind a step, with a wall model (Kopera et al. 2017)", separation::step),
    long("separation/cube", "turbulent flow around a cube on the floor, with a wall model (Martinuzzi & Tropea 1993)", separation::cube),
    short("statistics/known-signal", "means and variances on the device of 3·10⁵ samples in f32, against f64", statistics::known_signal),
    short("turbulence/inlet", "turbulence that a velocity face feeds: its intensity on the face and in the fluid", synthetic_turbulence::inlet),
    long("joint/stagnation", "stagnation point in an offset open joint (Gardner & Sitar 2018)", offset_joint::stagnation),
    long("joint/plucking", "velocity that moves the block of the scene plucking, beside block theory", plucking::run),
    short("joint/pressure", "pressure in joints under a step and a sine at their mouth, against a slot", joint_pressure::run),
    short("outlet/pulse", "what an outlet returns of a pulse of sound", outlet::pulse),
    short("stability/quiescent", "noise in fluid at rest calms down at every relaxation time", stability::quiescent),
    short("stability/taylor-green", "Taylor–Green vortices at Mach 0.3 and the lowest viscosity for 10⁴ steps", stability::taylor_green),
    short("surfaces/planes", "where planes of static solids lie along the grid and across it, exact and as staircases", surfaces::planes),
    short("surfaces/array", "drag of a simple cubic array of spheres that are static solids (Zick & Homsy 1982)", solids::array::at_rest),
    short("solids/volume", "solid fractions of cells add up to the volume of the block", solids::conservation::volume),
    short("solids/plates", "flow between two plates that are blocks", solids::plates::run),
    short("solids/surfaces", "where the surfaces of plates lie along the grid and across it", solids::plates::places),
    short("solids/array", "drag of a simple cubic array of spheres (Zick & Homsy 1982)", solids::array::drag),
    long("solids/array-offset", "drag of the array with the spheres shifted in their cells", solids::array::offset),
    short("solids/array-comparison", "drag of the array at other concentrations and by other operators", solids::array::comparison),
    short("solids/array-map", "error of the drag of the array over resolution and relaxation time", solids::array::map),
    short("solids/cubes", "drag of arrays of cubes, along the grid and turned, and of a polyhedron", solids::cubes::run),
    short("solids/rotation", "torque on a sphere that turns in a viscous fluid", solids::sphere::rotation),
    short("solids/turning", "a sphere that turns twice disturbs neither the fluid outside nor its own cells", solids::sphere::turning),
    short("solids/release", "acceleration of a sphere that is let go: its added mass", solids::sphere::release),
    short("solids/buoyancy", "buoyancy of a block at rest in a closed tank", solids::buoyancy::archimedes),
    short("solids/neutral", "a cube as heavy as water stays where it is", solids::buoyancy::neutral),
    short("solids/crossing", "a cube crosses the grid in fluid that moves with it and in fluid at rest", solids::crossing::run),
    short("solids/spike", "swing of a cube's drag as its faces cross cells", solids::crossing::swing),
    short("solids/momentum", "momentum and mass of fluid and blocks in a periodic box", solids::conservation::momentum),
    short("solids/lubrication", "force on a block driven towards a wall, against lubrication theory", solids::lubrication::run),
    short("solids/landing", "time in which a block sinks onto a wall, against lubrication theory", solids::lubrication::landing),
    short("solids/settling", "a sphere settles in oil, coarse (ten Cate et al. 2002)", solids::settling::short),
    long("solids/settling-whole", "spheres settle in oil on three grids (ten Cate et al. 2002)", solids::settling::whole),
    short("solids/cylinder", "cylinder in a channel at Re 20 (Schäfer & Turek 1996)", solids::cylinder::run),
    long("solids/sphere", "drag of a sphere in a stream", solids::obstacle::sphere),
    long("solids/cube", "drag of a cube in a stream (Hölzer & Sommerfeld 2008)", solids::obstacle::cube),
    long("solids/incline-flow", "drag of a cube on a bed of 30° in water that starts to run (Gardner & Sitar 2018)", solids::incline_flow::run),
    short("rock/incline", "a block slides on an incline, or sticks, by its friction angle", rock::incline::slides),
    short("rock/toppling", "a column on an incline topples if tan α > b/h", rock::incline::toppling),
    short("rock/twist", "a slab and a plank turn under a couple or a force at one end beyond their friction", rock::incline::twist),
    short("rock/rebound", "rebound of a block from a fixed one at four damping ratios", rock::dynamics::rebound),
    short("rock/free-body", "free rotation of an asymmetric body", rock::dynamics::free_body),
    short("rock/wedge", "wedges on two planes slide by their factor of safety (Goodman & Shi 1985)", rock::incline::wedge),
    short("rock/stack", "a crooked stack of ten cubes stands still", rock::rest::stack),
    short("rock/pyramid", "a pyramid of 55 cubes stands still", rock::rest::pyramid),
    short("rock/arch", "a masonry arch of fifteen stones stands still", rock::rest::arch),
    short("rock/contact-sign", "contact or not, against GJK and EPA", rock::detection::sign),
    short("rock/broadphase", "pairs of both broadphases against all pairs tried", rock::detection::broadphase),
    short("dda/critical-step", "critical time step of a deformable block", rock::deformable::critical_step),
    short("dda/spin", "centrifugal strain of a spinning deformable block", rock::deformable::spin),
    short("dda/vibration", "period of a cube that swings in its volume", rock::deformable::vibration),
    short("dda/bar", "stress and elongation of a hanging bar", rock::deformable::bar),
    short("dda/stack", "a stack of deformable and rigid cubes under its weight", rock::deformable::stack),
    short("dda/submerged", "stress of a deformable cube under the pressure of water", rock::submerged::run),
    short("dda/collision", "two bars meet end to end without damping", rock::deformable::collision),
    short("dda/rigid-limit", "a stiff block moves as a rigid one, the difference falls with 1/E", rock::deformable::rigid_limit),
    short("water/still", "hydrostatic pressure of water at rest", water::still::run),
    short("water/film", "film of viscous water down an incline", water::film::run),
    short("water/submerged", "buoyancy of a box under water and on the floor", water::buoyancy::submerged),
    short("water/stacked", "buoyancy of a box over another one at several gaps", water::buoyancy::stacked),
    short("water/floating", "draft of floating boxes", water::buoyancy::floating),
    short("water/standing-wave", "period and damping of a standing wave", water::wave::run),
    short("water/dam-break", "front of a dam break (Martin & Moyce 1952)", water::dam::run),
    short("water/wave-maker", "height of waves of a piston (Dean & Dalrymple 1991)", water::maker::piston),
    short("water/pushed", "pressure on the end walls of a tank that is pushed (Westergaard 1933)", water::pushed::run),
    long("water/solitary", "solitary wave of a falling box (Monaghan & Kos 2000)", water::maker::solitary),
    long("water/schemes", "the scheme of Geraili Mikola & Sitar (2014) against the default", water::schemes::run),
];

/// The cases whose names match.
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

/// The table of `cases`: name, `short` or `full`, what it computes. `full` cases run only with `--full`.
pub fn list(cases: &[Case]) -> String {
    let row = |case: &Case| {
        let form = if case.only_full { "full" } else { "short" };
        format!("{:26}{form:7}{}\n", case.name, case.about)
    };
    cases.iter().map(row).collect()
}

/// Runs the matching cases and prints the records of each case as it ends. Returns whether all passed.
/// A case that breaks off does not stop the others: it fails, and its record holds the error.
pub fn run(args: Args) -> anyhow::Result<bool> {
    let cases = select(args.case.as_deref())?;
    if args.list {
        print::print(&list(&cases))?;
        return Ok(true);
    }
    let context = CaseContext::open(args.adapter.as_deref(), args.full)?;
    // Read before the run: cases may take hours, during which other commits are made.
    let machine = Machine::of(&context.device.adapter_info());
    let mut records = Vec::new();
    println!("{}", record::header());
    for case in cases {
        if case.only_full && !args.full {
            println!("{}\n     left out, it runs with --full", case.name);
            continue;
        }
        records.append(&mut found(&context, &case));
    }
    if let Some(path) = &args.json {
        std::fs::write(path, machine.json(&records)?)
            .with_context(|| format!("cannot write {}", path.display()))?;
    }
    let failed = records.iter().filter(|record| !record.passed).count();
    let judged = records.iter().filter(|r| r.limit.is_some()).count();
    println!("{} of {judged} checks passed", judged - failed);
    Ok(failed == 0)
}

/// Runs a case and prints its records. A case that breaks off has one record, which holds the error.
pub(crate) fn found(context: &CaseContext, case: &Case) -> Vec<Record> {
    println!("{}", case.name);
    let mut found = (case.run)(context).unwrap_or_else(|error| vec![broken_off(&error)]);
    for record in &mut found {
        record.case = case.name.into();
        println!("{}", record::row(record));
    }
    found
}

/// The record of a case that could not finish.
fn broken_off(error: &anyhow::Error) -> Record {
    let trial = Trial {
        setup: format!("{error:#}"),
        ..Trial::default()
    };
    trial.at_least("runs to its end", 0.0, 1.0)
}
