//! Sums over the fluid and the blocks over time: `history.csv` and `history.png`.

use super::{
    recorder::{Recorder, RunLog},
    rock::Rocks,
    scene_run::SceneRun,
    table::TimeTable,
};
use crate::picture::Track;
use anyhow::Result;
use riprap::{
    scene::{self, Quantity},
    simulation::{Kind, Totals, WaterLedger},
};
use std::path::Path;

/// Points of a curve if the scene gives no interval: enough for a picture.
const POINTS: f64 = 200.0;

/// The recorder of the history with this number.
pub fn recorder(
    run: &SceneRun,
    folder: &Path,
    last: u64,
    number: usize,
) -> riprap::Result<Box<dyn Recorder>> {
    let scene = run.scene();
    let history = &scene.output.histories[number];
    // From the duration of the scene, not `--steps`, so that a run in parts continues one table.
    let usual = scene.run.length(run.time_step()) / POINTS;
    let quantities = history.quantities.clone();
    let track = |quantity: &Quantity| {
        let (label, unit, _) = about(*quantity, &Present::default());
        Track::new(label, unit, &[quantity.name()])
    };
    let table = TimeTable {
        name: scene::History::file_name(number),
        every: history.every.or(Some(usual)),
        columns: quantities.iter().map(|q| q.name().into()).collect(),
        coordinates: None,
        tracks: quantities.iter().map(track).collect(),
        title: scene.title.clone(),
    };
    table.recorder(run, folder, last, move |run, log| {
        let of_fluid = quantities.iter().any(|quantity| !quantity.is_of_blocks());
        let present = Present::of(run, of_fluid, log)?;
        let values = quantities.iter().map(|q| about(*q, &present).2);
        Ok(vec![values.collect()])
    })
}

/// Sums over fluid, water and blocks; zero for those that a scene lacks, whose quantities its checks refuse.
#[derive(Debug, Default)]
struct Present {
    fluid: Totals,
    water: WaterLedger,
    rocks: Rocks,
}

impl Present {
    fn of(run: &mut SceneRun, of_fluid: bool, log: &mut RunLog) -> Result<Self> {
        let mut present = Self {
            rocks: Rocks::of(run).unwrap_or_default(),
            ..Self::default()
        };
        match run.simulation.kind() {
            Kind::Lattice if of_fluid => {
                present.fluid = run.totals()?;
                log.max_speed = log.max_speed.max(present.fluid.max_speed);
            }
            Kind::Particles if of_fluid => {
                let totals = run.water_totals()?;
                present.fluid = Totals {
                    mass: totals.mass,
                    momentum: totals.momentum,
                    kinetic_energy: totals.kinetic_energy,
                    enstrophy: f64::NAN,
                    max_speed: totals.max_speed,
                    ..Totals::default()
                };
                present.water = run.water_ledger()?;
            }
            _ => {}
        }
        Ok(present)
    }
}

/// Name and unit of a quantity, and its present value.
fn about(quantity: Quantity, now: &Present) -> (&'static str, &'static str, f64) {
    let (fluid, water, rocks, ledger) = (&now.fluid, &now.water, &now.rocks, &now.rocks.ledger);
    let damping = ledger.dashpot + ledger.mass_damping + ledger.film;
    let potential = ledger.potential - rocks.start_potential;
    match quantity {
        Quantity::KineticEnergy => ("kinetic energy", "J", fluid.kinetic_energy),
        Quantity::Enstrophy => ("enstrophy", "m³/s²", fluid.enstrophy),
        Quantity::Mass => ("mass", "kg", fluid.mass),
        Quantity::MomentumX => ("momentum along x", "kg m/s", fluid.momentum[0]),
        Quantity::MomentumY => ("momentum along y", "kg m/s", fluid.momentum[1]),
        Quantity::MomentumZ => ("momentum along z", "kg m/s", fluid.momentum[2]),
        Quantity::MaxSpeed => ("largest speed", "m/s", fluid.max_speed),
        Quantity::BulkVelocity => ("bulk velocity", "m/s", fluid.bulk_velocity),
        Quantity::DrivingAcceleration => {
            ("driving acceleration", "m/s²", fluid.driving_acceleration)
        }
        Quantity::PotentialEnergy => ("potential energy", "J", water.potential),
        Quantity::CompressionEnergy => ("energy of compression", "J", water.compression),
        Quantity::EscapedEnergy => ("energy of what has left", "J", water.escaped),
        Quantity::BodyWork => ("work of blocks on water", "J", water.bodies),
        Quantity::PushWork => ("work of walls that push", "J", water.penalty),
        Quantity::DummyWork => ("work of dummy particles", "J", water.boundary),
        Quantity::DissipatedEnergy => ("energy that water dissipated", "J", water.dissipated()),
        Quantity::JointWork => ("work of blocks in joints", "J", water.joints),
        Quantity::LostToWater => ("energy of blocks lost to water", "J", water.blocks),
        Quantity::BlockKineticEnergy => ("kinetic energy of blocks", "J", ledger.kinetic),
        Quantity::BlockPotentialEnergy => ("potential energy of blocks", "J", potential),
        Quantity::StrainEnergy => ("strain energy of blocks", "J", ledger.strain),
        Quantity::ContactEnergy => ("elastic energy of contacts", "J", ledger.elastic),
        Quantity::FrictionWork => ("work of friction", "J", ledger.friction),
        Quantity::DampingWork => ("work of damping", "J", damping),
        Quantity::ContactLoss => ("loss in contacts that ended", "J", ledger.contact_loss),
        Quantity::OutsideWork => (
            "work of drives and loads",
            "J",
            ledger.driven + ledger.loads,
        ),
        Quantity::EnergyError => ("error of the energy", "", rocks.energy_error),
        Quantity::Contacts => ("contacts", "", rocks.contacts as f64),
        Quantity::AwakeBlocks => ("awake blocks", "", rocks.awake as f64),
        Quantity::BlockMaxSpeed => ("largest speed of a block", "m/s", rocks.max_speed),
        Quantity::MaxVonMises => ("largest von Mises stress", "Pa", rocks.max_von_mises),
    }
}

/// Unit of a quantity.
pub fn unit(quantity: Quantity) -> &'static str {
    about(quantity, &Present::default()).1
}
