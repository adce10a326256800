//! The complete state between two steps.

use super::{
    Blocks,
    body::State,
    candidate_pairs::{CandidatePair, SkinReference},
    contact_list::{Contact, ContactList},
    deforming::{Strain, norm},
    energy::WorkSums,
    films::Film,
};
use crate::{Error, Result};
use glam::DVec3;

/// Tolerated displacement of a fixed point since the start, in radii of the block.
const FIXED_POINT_TOLERANCE: f64 = 1e-6;

/// All data on which the next steps depend: poses, momenta, deformations, forces, contact histories, caches of the
/// resolver, the ledger. Constants such as shapes are in the
/// [`Setup`](super::Setup).
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct Snapshot {
    time: f64,
    steps: u64,
    time_step: f64,
    started: bool,
    states: Vec<State>,
    skin_references: Vec<SkinReference>,
    pairs: Vec<CandidatePair>,
    contacts: Vec<Contact>,
    films: Vec<Film>,
    /// Forces of the films in the last step, N.
    film_forces: Vec<(u32, DVec3)>,
    work_sums: WorkSums,
    /// States of deformable blocks.
    strains: Vec<Strain>,
}

impl Snapshot {
    /// Time, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Size in memory, bytes.
    pub fn bytes(&self) -> u64 {
        let lists = [
            size_of_val(&*self.states),
            size_of_val(&*self.skin_references),
            size_of_val(&*self.pairs),
            size_of_val(&*self.contacts),
            size_of_val(&*self.films),
            size_of_val(&*self.film_forces),
            size_of_val(&*self.strains),
        ];
        let bonds = self.contacts.iter().flat_map(|contact| &contact.bond);
        let bonds = bonds.map(|bond| size_of_val(&**bond) + size_of_val(&*bond.corners));
        (size_of::<Self>() + lists.iter().sum::<usize>() + bonds.sum::<usize>()) as u64
    }
}

impl Blocks {
    /// The present state.
    pub fn snapshot(&self) -> Snapshot {
        let mut snapshot = Snapshot::default();
        self.save(&mut snapshot);
        snapshot
    }

    /// Stores the present state in the memory of an older one.
    pub fn save(&self, snapshot: &mut Snapshot) {
        snapshot.time = self.time;
        snapshot.steps = self.steps;
        snapshot.time_step = self.time_step;
        snapshot.started = self.started;
        snapshot.states.clone_from(&self.states);
        snapshot.skin_references.clone_from(&self.skin_references);
        snapshot.pairs.clone_from(&self.pairs);
        self.contacts
            .list(&mut snapshot.pairs, &mut snapshot.contacts);
        snapshot.films.clear();
        snapshot.films.extend(self.contacts.films());
        snapshot.film_forces.clone_from(&self.films.forces);
        snapshot.work_sums = self.work_sums;
        snapshot.strains.clone_from(&self.deforming.strains);
    }

    /// Restores an earlier or later state of the same setup. The following steps have the same bits as those that
    /// followed when it was taken.
    ///
    /// Blocks that are fixed here and moved there stop.
    ///
    /// # Errors
    /// [`Error::Argument`] if the state belongs to other blocks, or if points are fixed that have moved.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Result<()> {
        let parts = self.parts.block.len() as u32;
        let blocks = self.len() as u32;
        let image_shift = |offset| self.period().map(|period| period.shift(offset));
        let known = |pair: &CandidatePair| {
            pair.parts.iter().all(|&part| part < parts)
                && (pair.offset == [0; 3]
                    || image_shift(pair.offset).is_some_and(|image_shift| image_shift.is_finite()))
                && (pair.contact == super::contact_list::NO_CONTACT
                    || (pair.contact as usize) < snapshot.contacts.len())
        };
        let own = |contact: &Contact| {
            contact
                .parts
                .iter()
                .zip(contact.blocks)
                .all(|(&part, block)| self.parts.block.get(part as usize) == Some(&block))
        };
        let fits = snapshot.states.len() == self.len()
            && snapshot.strains.len() == self.deforming.strains.len()
            && (snapshot.skin_references.is_empty()
                || snapshot.skin_references.len() == self.len())
            && snapshot.pairs.iter().all(known)
            && snapshot.contacts.iter().all(own)
            && snapshot
                .films
                .iter()
                .all(|film| film.blocks.iter().all(|&block| block < blocks))
            && snapshot
                .film_forces
                .iter()
                .all(|&(block, _)| block < blocks);
        if !fits {
            let message = format!(
                "it is of another scene: it holds {} blocks, {} of them deformable, this one {} and {}",
                snapshot.states.len(),
                snapshot.strains.len(),
                self.len(),
                self.deforming.strains.len()
            );
            return Err(Error::argument("snapshot", message));
        }
        self.check_fixed_points(snapshot)?;
        self.time = snapshot.time;
        self.steps = snapshot.steps;
        self.time_step = snapshot.time_step;
        self.started = snapshot.started;
        self.states.clone_from(&snapshot.states);
        for (state, body) in self.states.iter_mut().zip(&self.bodies) {
            if body.is_fixed() {
                (state.velocity, state.spin, state.momentum) = Default::default();
            }
        }
        self.skin_references.clone_from(&snapshot.skin_references);
        self.pairs.clone_from(&snapshot.pairs);
        self.contacts = ContactList::from_list(&snapshot.contacts, &snapshot.films);
        self.films.forces.clone_from(&snapshot.film_forces);
        self.work_sums = snapshot.work_sums;
        self.deforming.strains.clone_from(&snapshot.strains);
        self.place();
        Ok(())
    }

    /// Checks that the fixed points of deformable blocks are where they were at the start.
    fn check_fixed_points(&self, snapshot: &Snapshot) -> Result<()> {
        for (one, strain) in self.deforming.list.iter().zip(&snapshot.strains) {
            let (body, centre) = (&self.bodies[one.block], snapshot.states[one.block].centre);
            let placed = one.constraints.place((centre, strain.deformation));
            let moved =
                (placed.0 - centre).length() + norm(placed.1 - strain.deformation) * body.radius;
            if moved > FIXED_POINT_TOLERANCE * body.radius {
                let message = format!(
                    "its fixed points have moved by {moved:.2e} m since the start of the scene; points can be fixed from the \
                     start only"
                );
                return Err(Error::argument(format!("block {}", body.name), message));
            }
        }
        Ok(())
    }
}
