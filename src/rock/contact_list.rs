//! Contacts of all pairs, in the order of the pairs, and their sums over each block.

use super::{
    Body, body::MidStep, candidate_pairs::CandidatePair, deforming::DeformingBlocks, films::Film,
    narrowphase::Joints,
};
use crate::rock::{
    contact::{Bond, ContactGeometry, Placed},
    law::{Force, Stiffness},
};
use glam::DVec3;
use std::sync::Arc;

/// Index that stands for no contact.
pub(super) const NO_CONTACT: u32 = u32::MAX;

/// Ratio of the smaller centroid-to-face distance, of which overlap limits are shares, to the limit of the
/// resolver.
pub(super) const DISTANCES_PER_LIMIT: f64 = 10.0;

/// A contact. Vectors are in world axes.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Contact {
    pub parts: [u32; 2],
    pub blocks: [u32; 2],
    /// Shift of the second part to its periodic image near the first, m: whole periods.
    pub image_shift: DVec3,
    /// Point of contact, m.
    pub point: DVec3,
    /// Point at which the force acts, m.
    pub pressure_centre: DVec3,
    /// Unit normal from the first part to the second.
    pub normal: DVec3,
    /// Overlap, m.
    pub overlap: f64,
    /// Area over which the springs act, m²; 0 while the pair touches within rounding.
    pub area: f64,
    /// Area of the section itself, over which the strength acts, m².
    pub section: f64,
    /// Largest extent of the section, m.
    pub width: f64,
    /// Largest overlap for which the blocks count as hard, m.
    pub limit: f64,
    /// Force on the second block.
    pub force: Force,
    /// The bond between the faces.
    pub bond: Option<Arc<Bond>>,
    /// Work done on the springs, less the work of friction, J.
    pub stored: f64,
    /// Rate of work on the springs at the end of the last step, W.
    pub power: f64,
}

/// Number of pairs per task: enough to outweigh the overhead of a task.
pub(super) const CHUNK: usize = 64;

/// Contacts in one list per [`CHUNK`] pairs. Each task writes a list of its own; the step
/// after the next reuses it.
#[derive(Clone, Debug, Default)]
pub(super) struct ContactList {
    pub chunks: Vec<Chunk>,
}

/// Contacts of neighbouring pairs.
#[derive(Clone, Debug, Default)]
pub(super) struct Chunk {
    /// At most [`CHUNK`].
    pub contacts: Vec<Contact>,
    /// Films in the gaps of pairs that nearly touch.
    pub films: Vec<Film>,
    /// Contacts whose forces are to be found, by their index, and their geometry.
    pub geometries: Vec<(usize, ContactGeometry)>,
    /// Energy in the springs of contacts that ended in this step, J.
    pub ended: Vec<f64>,
    /// Scratch memory for the image of a part.
    pub image: Placed,
    /// Power of the dashpots of each contact on the blocks, W; negative if they dissipate energy.
    pub dashpots: Vec<f64>,
}

impl ContactList {
    /// Makes room for the contacts of `pairs` pairs.
    pub fn reset(&mut self, pairs: usize) {
        let count = pairs.div_ceil(CHUNK);
        self.chunks.resize_with(count, Chunk::default);
    }

    pub fn iter(&self) -> impl Iterator<Item = &Contact> {
        self.chunks.iter().flat_map(|chunk| &chunk.contacts)
    }

    /// The films of all pairs, in the order of the pairs.
    pub fn films(&self) -> impl Iterator<Item = &Film> {
        self.chunks.iter().flat_map(|chunk| &chunk.films)
    }

    /// The contact of a pair, if it has one.
    pub fn of(&self, pair: &CandidatePair) -> Option<&Contact> {
        let id = pair.contact as usize;
        (pair.contact != NO_CONTACT).then(|| &self.chunks[id / CHUNK].contacts[id % CHUNK])
    }

    /// Copies all contacts into one list, and writes their indices in it into `pairs`.
    pub fn list(&self, pairs: &mut [CandidatePair], list: &mut Vec<Contact>) {
        list.clear();
        let mut firsts = Vec::with_capacity(self.chunks.len());
        for chunk in &self.chunks {
            firsts.push(list.len() as u32);
            list.extend_from_slice(&chunk.contacts);
        }
        for pair in pairs.iter_mut().filter(|pair| pair.contact != NO_CONTACT) {
            let id = pair.contact as usize;
            pair.contact = firsts[id / CHUNK] + (id % CHUNK) as u32;
        }
    }

    /// Splits a list of contacts, to which pairs refer by index, into chunks. All films go to the first chunk.
    pub fn from_list(list: &[Contact], films: &[Film]) -> Self {
        let chunk = |contacts: &[Contact]| Chunk {
            contacts: contacts.to_vec(),
            ..Chunk::default()
        };
        let mut chunks: Vec<Chunk> = list.chunks(CHUNK).map(chunk).collect();
        if !films.is_empty() {
            chunks.resize_with(chunks.len().max(1), Chunk::default);
            chunks[0].films = films.to_vec();
        }
        Self { chunks }
    }
}

/// One contact at the end of the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// First and second block.
    pub blocks: [usize; 2],
    /// First and second part, among the parts of all blocks.
    pub parts: [usize; 2],
    /// Point at which the force acts on the first block, m.
    pub point: DVec3,
    /// Shift of the second block to its image near the first, m: zero, or whole periods.
    pub image_shift: DVec3,
    /// Unit normal from the first block to the second.
    pub normal: DVec3,
    /// Force on the second block, N; the first gets the opposite.
    pub force: DVec3,
    /// Overlap, m.
    pub overlap: f64,
    /// Area over which its springs act, m².
    pub area: f64,
    /// Area of the section itself, m², over which cohesion acts: smaller than `area` if
    /// [`Setup::corner_area`](super::Setup::corner_area) applies.
    pub section: f64,
    /// Whether its bond is intact.
    pub bonded: bool,
}

impl ContactPoint {
    pub(super) fn of(contact: &Contact) -> Self {
        Self {
            blocks: contact.blocks.map(|block| block as usize),
            parts: contact.parts.map(|part| part as usize),
            point: contact.pressure_centre,
            image_shift: contact.image_shift,
            normal: contact.normal,
            force: contact.force.total(),
            overlap: contact.overlap,
            area: contact.area,
            section: contact.section,
            bonded: contact.force.history.bonded,
        }
    }
}

/// Sums over the contacts of one block.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ContactSum {
    /// Force, N.
    pub force: DVec3,
    /// Torque about the centroid, N m.
    pub torque: DVec3,
    /// Stiffness of the springs that act on it.
    pub stiffness: Stiffness,
}

/// Sums the contacts of each block into `contact_sums`, in the order of the contacts.
pub(super) fn sum_contacts(
    contacts: &ContactList,
    bodies: &[Body],
    deforming: &DeformingBlocks,
    mid_steps: &[MidStep],
    joints: &Joints,
    contact_sums: &mut Vec<ContactSum>,
) {
    contact_sums.clear();
    contact_sums.resize(mid_steps.len(), ContactSum::default());
    for contact in contacts.iter() {
        let [a, b] = contact.blocks.map(|block| block as usize);
        let joint = joints.of(mid_steps[a].material, mid_steps[b].material);
        let (force, moment) = (contact.force.total(), contact.force.couple());
        let at = contact.pressure_centre;
        for (block, at, force, moment) in [
            (a, at, -force, -moment),
            (b, at - contact.image_shift, force, moment),
        ] {
            let sum = &mut contact_sums[block];
            let arm = at - mid_steps[block].centre;
            sum.force += force;
            sum.torque += arm.cross(force) + moment;
            // If all blocks are rigid, the bodies, which are far away in memory, are not read.
            let (arm, width) = match deforming.is_empty() {
                true => (arm, contact.width),
                false => deforming.lever(&bodies[block], arm, contact.width),
            };
            sum.stiffness.add(joint, contact.area, arm, width);
        }
    }
}
