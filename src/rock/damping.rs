//! Shares of contacts in the damping of two bodies.
//!
//! The dashpots between two bodies have the share ζ of the critical damping of all their contacts together, whatever the number of
//! parts: cᵢ = 2ζ√(m* kᵢ) √(kᵢ/K), with K = Σⱼ kⱼ (nᵢ·nⱼ)² the stiffness of all contacts along the normal of contact i. All
//! fixed and driven blocks count as one body.

use super::{
    Body,
    body::MidStep,
    candidate_pairs::PlacedParts,
    contact_list::{Contact, ContactList},
    narrowphase::Joints,
};
use glam::DMat3;
use std::collections::HashMap;

/// Stiffness of the contacts of pairs of bodies.
#[derive(Debug, Default)]
pub(super) struct DampingShares {
    /// Of each block with the fixed and driven ones.
    with_immovable: Vec<Sum>,
    /// Of two others, if they may have several contacts.
    with_others: HashMap<[u32; 2], Sum>,
}

#[derive(Clone, Copy, Debug)]
struct Sum {
    contacts: u32,
    /// Σ k n nᵀ, N/m.
    stiffness: DMat3,
}

impl Default for Sum {
    fn default() -> Self {
        Self {
            contacts: 0,
            // The default of a matrix is the identity.
            stiffness: DMat3::ZERO,
        }
    }
}

/// What determines the bodies of a contact.
#[derive(Clone, Copy)]
pub(super) struct Bodies<'a> {
    pub bodies: &'a [Body],
    pub parts: &'a PlacedParts,
    pub mid_steps: &'a [MidStep],
    pub joints: &'a Joints,
    /// Whether two parts may touch in several images.
    pub repeated: bool,
}

/// Key of the sums of a contact.
enum Key {
    Immovable(u32),
    Others([u32; 2]),
    /// The only contact of its bodies.
    Single,
}

impl Bodies<'_> {
    fn key(&self, contact: &Contact) -> Key {
        let [a, b] = contact.blocks;
        match [a, b].map(|block| self.bodies[block as usize].inverse_mass() == 0.0) {
            [false, true] => Key::Immovable(a),
            [true, false] => Key::Immovable(b),
            _ if self.repeated || self.has_parts(contact.parts) => Key::Others([a, b]),
            _ => Key::Single,
        }
    }

    /// Whether one of the two parts belongs to a block of several. These have consecutive numbers.
    fn has_parts(&self, parts: [u32; 2]) -> bool {
        let blocks = &self.parts.block;
        parts.into_iter().any(|part| {
            let part = part as usize;
            let own = Some(&blocks[part]);
            blocks.get(part + 1) == own || (part > 0 && blocks.get(part - 1) == own)
        })
    }

    fn stiffness(&self, contact: &Contact) -> f64 {
        let [a, b] = contact.blocks.map(|block| &self.mid_steps[block as usize]);
        self.joints.of(a.material, b.material).normal_stiffness * contact.area
    }
}

impl DampingShares {
    /// The shares of all `contacts`.
    pub fn of(contacts: &ContactList, bodies: Bodies<'_>) -> Self {
        let mut shares = Self {
            with_immovable: vec![Sum::default(); bodies.mid_steps.len()],
            with_others: HashMap::new(),
        };
        for contact in contacts.iter().filter(|contact| contact.area > 0.0) {
            let sum = match bodies.key(contact) {
                Key::Immovable(block) => &mut shares.with_immovable[block as usize],
                Key::Others(blocks) => shares.with_others.entry(blocks).or_default(),
                Key::Single => continue,
            };
            let n = contact.normal;
            sum.contacts += 1;
            sum.stiffness +=
                DMat3::from_cols(n * n.x, n * n.y, n * n.z) * bodies.stiffness(contact);
        }
        shares
    }

    /// Share kᵢ/K of one of the contacts.
    pub fn share(&self, contact: &Contact, bodies: Bodies<'_>) -> f64 {
        let sum = match bodies.key(contact) {
            Key::Immovable(block) => self.with_immovable.get(block as usize),
            Key::Others(blocks) => self.with_others.get(&blocks),
            Key::Single => None,
        };
        match sum {
            Some(sum) if sum.contacts > 1 => {
                let n = contact.normal;
                (bodies.stiffness(contact) / n.dot(sum.stiffness * n)).min(1.0)
            }
            _ => 1.0,
        }
    }
}
