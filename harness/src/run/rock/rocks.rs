//! A run of blocks in numbers.

use super::super::{recorder::RunLog, scene_run::SceneRun, throughput::Throughput};
use super::Rock;
use riprap::rock::EnergyLedger;
use serde::{Serialize, Serializer};
use std::fmt;

/// What blocks did.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Rocks {
    /// Number of blocks, fixed ones included.
    pub blocks: usize,
    /// Blocks that move or might at the end: neither fixed nor asleep.
    pub awake: usize,
    /// Contacts at the end.
    pub contacts: usize,
    /// Pairs at the end that may touch.
    pub pairs: usize,
    /// Pairs tested for contact in this run.
    pub tests: u64,
    /// Linear programs that this took.
    pub programs: u64,
    /// Seconds of this run's steps, without what was written.
    pub seconds: f64,
    /// Longest sub-step at the end, s.
    pub sub_step: f64,
    /// Largest speed of a centroid at the end, m/s.
    pub max_speed: f64,
    /// Largest speed of a centroid that was seen, m/s.
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
    /// What the balance of energies has gained since the start, as a part of what was turned over. The balance counts
    /// what ended contacts held, [`EnergyLedger::lost`].
    pub energy_error: f64,
    /// What contacts held when they ended, as a part of what was turned over: the error of the contact law, positive
    /// where it takes energy out.
    pub contact_loss: f64,
    /// Steps a second, without what was written and without the first ones, in which kernels are compiled.
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
            max_speed_seen: rock.max_speed(),
            energy_error: rock.of_turnover(&ledger, ledger.balance() - rock.start.balance()),
            contact_loss: rock.of_turnover(&ledger, ledger.lost - rock.start.lost),
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
            max_speed_seen: log.block_speed.max(now.max_speed),
            seconds: throughput.whole().time.as_secs_f64(),
            steps_a_second: warm.rate(warm.steps),
            ..now
        })
    }
}

impl Rock<'_> {
    /// `energy` as a part of what has been turned over: the kinetic energy now and at the start, the change of the
    /// potential one, the strain, all that was taken, and what was put in.
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
            + now.lost.abs()
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
        ("lost", ledger.lost),
        ("driven", ledger.driven),
        ("loads", ledger.loads),
    ])
}

impl fmt::Display for Rocks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "  {} blocks, {} awake, {} contacts; {:.0} steps/s; speed {:.3e} m/s (largest seen \
             {:.3e}); energies close to {:.1e}, contacts that ended took {:.1e}",
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
