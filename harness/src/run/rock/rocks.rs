//! The blocks in the summary of a run.

use super::super::{recorder::RunLog, scene_run::SceneRun, throughput::Throughput};
use super::Rock;
use riprap::rock::EnergyLedger;
use serde::{Serialize, Serializer};
use std::fmt;

/// State and work of the blocks of a run.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Rocks {
    /// Number of blocks, fixed ones included.
    pub blocks: usize,
    /// Blocks that are neither fixed nor asleep at the end.
    pub awake: usize,
    /// Contacts at the end.
    pub contacts: usize,
    /// Candidate pairs at the end.
    pub pairs: usize,
    /// Pairs tested for contact in this run.
    pub tests: u64,
    /// Linear programs solved for these tests.
    pub programs: u64,
    /// Seconds of this run's steps, without output.
    pub seconds: f64,
    /// Longest sub-step at the end, s.
    pub sub_step: f64,
    /// Largest speed of a centroid at the end, m/s.
    pub max_speed: f64,
    /// Largest observed speed of a centroid, m/s.
    pub max_speed_seen: f64,
    /// Energies, J.
    #[serde(serialize_with = "energies")]
    pub ledger: EnergyLedger,
    /// Potential energy at the start of the scene, J.
    #[serde(skip)]
    pub start_potential: f64,
    /// Largest von Mises stress of deformable blocks, Pa.
    #[serde(skip)]
    pub max_von_mises: f64,
    /// Energy gained by the balance since the start, as a fraction of the energy turned over. The balance includes the energy
    /// that contacts held when they ended, [`EnergyLedger::contact_loss`].
    pub energy_error: f64,
    /// Energy that contacts held when they ended, as a fraction of the energy turned over: the error of the contact law,
    /// positive if it removes energy.
    pub contact_loss: f64,
    /// Steps per second, without output and without the first steps, in which kernels are compiled.
    pub steps_a_second: f64,
}

impl Rocks {
    /// The present state of the blocks of `run`, if it has any.
    pub fn of(run: &SceneRun) -> Option<Self> {
        let rock = run.rock()?;
        let blocks = rock.blocks;
        let ledger = blocks.ledger();
        Some(Self {
            blocks: rock.shown,
            awake: rock.awake(),
            contacts: blocks.contacts().count(),
            pairs: blocks.candidate_pair_count(),
            tests: blocks.counts().pairs,
            programs: blocks.counts().programs,
            seconds: 0.0,
            sub_step: blocks.time_step().min(run.time_step()),
            max_speed: rock.max_speed(),
            max_speed_seen: blocks.peak_speed().max(rock.max_speed()),
            energy_error: rock.of_turnover(&ledger, ledger.balance() - rock.start.balance()),
            contact_loss: rock.of_turnover(&ledger, ledger.contact_loss - rock.start.contact_loss),
            ledger,
            start_potential: rock.start.potential,
            max_von_mises: (0..rock.shown)
                .filter_map(|block| blocks.von_mises(block))
                .fold(0.0, f64::max),
            steps_a_second: 0.0,
        })
    }

    /// The state at the end of a run.
    pub fn finished(run: &SceneRun, log: &RunLog, throughput: &Throughput) -> Option<Self> {
        let now = Self::of(run)?;
        let warm = throughput.warm();
        Some(Self {
            max_speed_seen: log.block_speed.max(now.max_speed_seen),
            seconds: throughput.whole().time.as_secs_f64(),
            steps_a_second: warm.rate(warm.steps),
            ..now
        })
    }
}

impl Rock<'_> {
    /// `energy` as a fraction of the energy turned over: the kinetic energy now and at the start, the changes of potential
    /// and strain energy, all energy dissipated or held, and the work of drives and loads.
    fn of_turnover(&self, now: &EnergyLedger, energy: f64) -> f64 {
        let turned = now.kinetic
            + self.start.kinetic
            + (now.potential - self.start.potential).abs()
            + (now.strain - self.start.strain).abs()
            + now.elastic.abs()
            + now.friction
            + now.dashpot
            + now.mass_damping
            + now.film
            + now.contact_loss.abs()
            + now.driven.abs()
            + now.loads.abs();
        if turned > 0.0 { energy / turned } else { 0.0 }
    }
}

fn energies<S: Serializer>(ledger: &EnergyLedger, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map([
        ("kinetic", ledger.kinetic),
        ("potential", ledger.potential),
        ("strain", ledger.strain),
        ("elastic", ledger.elastic),
        ("friction", ledger.friction),
        ("dashpot", ledger.dashpot),
        ("mass_damping", ledger.mass_damping),
        ("film", ledger.film),
        ("lost", ledger.contact_loss),
        ("driven", ledger.driven),
        ("loads", ledger.loads),
    ])
}

impl fmt::Display for Rocks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "  {} blocks, {} awake, {} contacts; {:.0} steps/s; speed {:.3e} m/s (largest seen \
             {:.3e}); error of the energy balance {:.1e}, energy lost with contacts that ended {:.1e}",
            self.blocks,
            self.awake,
            self.contacts,
            self.steps_a_second,
            self.max_speed,
            self.max_speed_seen,
            self.energy_error.abs(),
            self.contact_loss
        )
    }
}
