//! Where the time of a step goes.

use super::{
    contact::Film,
    core::{Core, Cost},
};
use glam::{DQuat, DVec3};
use kit::pile::Pile;
use riprap::{
    Result,
    rock::{
        broadphase::{Broadphase, HostBroadphase},
        law::{self, History, Motion, Section},
    },
};
use serde::Serialize;
use std::{fmt, hint::black_box};

/// Parts of a step on one core, ms of CPU time, each measured by itself on the same blocks.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Split {
    /// A new list of pairs: boxes, search, taking over. Not in every step.
    pub ms_broadphase: f64,
    /// Lists a step.
    pub lists_a_step: f64,
    /// Pairs that are not in contact.
    pub ms_decision: f64,
    /// Pairs in contact: the cached point proves it; centre, normal and section.
    pub ms_contact: f64,
    /// The force law of all contacts.
    pub ms_law: f64,
    /// A step of the same blocks without pairs: flight, placing, second kick, ledger.
    pub ms_motion: f64,
    /// What is left of the step: sums, ledger of the contacts, stability bound, lists.
    pub ms_rest: f64,
}

impl Split {
    /// The parts of a step that takes `whole` s.
    ///
    /// # Errors
    /// If a step fails.
    pub fn of(
        core: &Core,
        pile: &mut Pile,
        film: &Film,
        sorted: &[Vec<usize>; 2],
        whole: f64,
        lists_a_step: f64,
        rounds: usize,
    ) -> Result<Self> {
        let [contact, decision] = [0, 1].map(|k| film.measure(core, &sorted[k], false, rounds));
        let (contact, decision) = (contact?.cost.cpu, decision?.cost.cpu);
        let broadphase = list(core, pile, rounds)?;
        let law = forces(core, pile, rounds)?;
        let motion = motion(core, pile, rounds)?;
        Ok(Self {
            ms_broadphase: 1e3 * broadphase,
            lists_a_step,
            ms_decision: 1e3 * decision,
            ms_contact: 1e3 * contact,
            ms_law: 1e3 * law,
            ms_motion: 1e3 * motion,
            ms_rest: 1e3 * (whole - decision - contact - law - motion),
        })
    }
}

/// A new list of pairs, s.
fn list(core: &Core, pile: &mut Pile, rounds: usize) -> Result<f64> {
    let mut cost = Cost::NONE;
    for _ in 0..rounds {
        let ((), took) = core.time(|| {
            let pairs = pollster::block_on(HostBroadphase.pairs(&pile.blocks.aabbs()))?;
            pile.blocks.set_pairs(pairs)
        })?;
        cost = cost.lower(took);
    }
    Ok(cost.cpu)
}

/// The law on the sections of all contacts, s.
fn forces(core: &Core, pile: &Pile, rounds: usize) -> Result<f64> {
    let (joint, dt) = (pile.joint(), pile.blocks.time_step());
    let work = pile.blocks.contacts().map(|contact| {
        let section = Section {
            normal: contact.normal,
            overlap: contact.overlap,
            area: contact.area,
            elastic_area: contact.area,
            rolls: false,
            opening: 0.0,
        };
        let motion = Motion {
            displacement: 1e-8 * DVec3::ONE,
            velocity: 1e-4 * DVec3::ONE,
            spin: DVec3::ZERO,
            frame: DQuat::IDENTITY,
            time_step: dt,
            mass: pile.blocks.mass(contact.blocks[0]),
        };
        let pressing = contact.force.dot(contact.normal);
        let history = History {
            shear: contact.force - pressing * contact.normal,
            normal: contact.normal,
            ..History::default()
        };
        (section, motion, history)
    });
    let work: Vec<_> = work.collect();
    let mut cost = Cost::NONE;
    for _ in 0..rounds {
        let ((), took) = core.time(|| {
            for (section, motion, history) in &work {
                black_box(law::force(joint, section, motion, history));
            }
            Ok(())
        })?;
        cost = cost.lower(took);
    }
    Ok(cost.cpu)
}

/// A step without pairs, s.
fn motion(core: &Core, pile: &Pile, rounds: usize) -> Result<f64> {
    let mut blocks = pile.apart()?;
    let mut cost = Cost::NONE;
    for _ in 0..rounds {
        if blocks.wants_pairs() {
            blocks.set_pairs(Vec::new())?;
        }
        let ((), took) = core.time(|| blocks.step())?;
        cost = cost.lower(took);
    }
    Ok(cost.cpu)
}

impl fmt::Display for Split {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "of it ms: decision {:.3}, contact {:.3}, law {:.3}, motion {:.3}, rest {:.3}; a list of pairs {:.3}, {:.3} lists a step",
            self.ms_decision,
            self.ms_contact,
            self.ms_law,
            self.ms_motion,
            self.ms_rest,
            self.ms_broadphase,
            self.lists_a_step
        )
    }
}
