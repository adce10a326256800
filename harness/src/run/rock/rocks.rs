//! A run of blocks in numbers.

use super::super::{recorder::RunLog, scene_run::SceneRun, throughput::Throughput};
use serde::Serialize;
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
    pub ledger: Energies,
    /// What the balance of energies has gained since the start, as a part of what was turned over.
    pub energy_error: f64,
    /// What contacts held when they ended, as a part of what was turned over.
    pub contact_loss: f64,
    /// Steps a second, without what was written and without the first ones, in which kernels are compiled.
    pub steps_a_second: f64,
}

/// Energies of blocks, J.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Energies {
    /// Kinetic.
    pub kinetic: f64,
    /// Potential in gravity, from the origin of the coordinates.
    pub potential: f64,
    /// Of strain, in the deformable blocks.
    pub strain: f64,
    /// In the springs of the present contacts; may be negative, see [`riprap::rock::EnergyLedger`].
    pub elastic: f64,
    /// Taken by friction.
    pub friction: f64,
    /// Taken by the dashpots of contacts.
    pub dashpot: f64,
    /// Taken by mass damping.
    pub mass_damping: f64,
    /// Taken by films of fluid between blocks that nearly touch.
    pub film: f64,
    /// Held by the springs of contacts when these ended: taken out, or put in where it is negative.
    pub lost: f64,
    /// Done by driven blocks.
    pub driven: f64,
    /// Done by loads.
    pub loads: f64,
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
            energy_error: rock.energy_error(&ledger),
            contact_loss: rock.contact_loss(&ledger),
            ledger: Energies {
                kinetic: ledger.kinetic,
                potential: ledger.potential,
                strain: ledger.strain,
                elastic: ledger.elastic,
                friction: ledger.friction,
                dashpot: ledger.dashpot,
                mass_damping: ledger.mass_damping,
                film: ledger.film,
                lost: ledger.lost,
                driven: ledger.driven,
                loads: ledger.loads,
            },
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
