//! The energy ledger: energies of the blocks and works on them. Works follow the trapezoidal rule over a step, as in
//! velocity Verlet.

use super::{
    Body,
    body::State,
    contact_list::{Chunk, ContactList},
    deforming::{DeformingBlocks, StepParams},
    threads,
};
use crate::{geometry::skew, rock::law::inner};
use glam::{DMat3, DVec3};
use rayon_cond::CondIterator;

/// Present energies, and works since the start, J.
///
/// Only free blocks contribute kinetic and potential energy. The springs of the contact law conserve energy
/// only while the area of their contact is constant (k_n A u_n has a potential in u_n alone). Their energy is
/// therefore defined as the work done on them, and the energy left when their contact ends is counted
/// as `contact_loss`, positive or negative.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyLedger {
    /// ½mv² + ½ω·L of the rigid free blocks; ½mv² + ½ tr Ḟ S Ḟᵀ of the deformable ones.
    pub kinetic: f64,
    /// −m g·x of the free blocks, relative to the origin.
    pub potential: f64,
    /// ∫ ½E:C:E + σ₀:E of the deformable blocks.
    pub strain: f64,
    /// Work done on the springs of the present contacts, less the work of friction. Negative if the area of a
    /// contact grew while it was compressed: its springs then return more energy than they took up.
    pub elastic: f64,
    /// Dissipated by friction.
    pub friction: f64,
    /// Dissipated by the dashpots of the contacts.
    pub dashpot: f64,
    /// Dissipated by the mass damping α, by the viscous stresses of deformable blocks in a fluid
    /// ([`Blocks::set_load_interval`](super::Blocks::set_load_interval)), and by blocks that fall asleep.
    pub mass_damping: f64,
    /// Dissipated by films of fluid between blocks that nearly touch.
    pub film: f64,
    /// Energy of springs whose contact ended: lost by the contact law, or gained if negative.
    pub contact_loss: f64,
    /// Work done on the blocks by the prescribed motion of the driven ones.
    pub driven: f64,
    /// Work done on the blocks by external loads, point loads and accelerations.
    pub loads: f64,
}

impl EnergyLedger {
    /// Present and dissipated energy, less the work done on the blocks: constant up to the error of the time
    /// integration.
    pub fn balance(&self) -> f64 {
        self.kinetic + self.potential + self.strain + self.elastic + self.dissipated()
            - self.driven
            - self.loads
    }

    /// Energy removed for good: dissipated, or lost with the contacts that ended.
    pub fn dissipated(&self) -> f64 {
        self.friction + self.dashpot + self.mass_damping + self.film + self.contact_loss
    }
}

/// Sums since the start, J, and the powers at the end of the last step, W.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct WorkSums {
    pub friction: f64,
    pub contact_loss: f64,
    pub film: f64,
    /// Work of the dashpots, the mass damping, the driven blocks and the loads.
    pub work: [f64; 4],
    pub power: [f64; 4],
}

/// All blocks and their state.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyStates<'a> {
    pub bodies: &'a [Body],
    pub states: &'a [State],
    pub deforming: &'a DeformingBlocks,
}

impl BodyStates<'_> {
    /// Velocity of a block at the point `at` (m), m/s.
    fn velocity(&self, block: usize, at: DVec3) -> DVec3 {
        let state = &self.states[block];
        let r = at - state.centre;
        // If all blocks are rigid, the bodies, which are far away in memory, are not read.
        let strained = !self.deforming.is_empty();
        let strain = strained
            .then(|| self.deforming.of(&self.bodies[block]))
            .flatten();
        match strain {
            None => state.velocity + state.spin.cross(r),
            Some((_, strain)) => state.velocity + strain.gradient() * r,
        }
    }
}

impl WorkSums {
    /// Adds the work of a step that ends with `contacts` and the velocities of `all`.
    pub fn add_step(
        &mut self,
        all: BodyStates<'_>,
        contacts: &mut ContactList,
        params: StepParams,
    ) {
        let BodyStates {
            bodies,
            states,
            deforming,
        } = all;
        let (damping, dt) = (params.damping, params.dt);
        let many = contacts.chunks.len() >= threads::CHUNKS;
        let chunks = CondIterator::new(&mut contacts.chunks, many);
        chunks.for_each(|chunk| work(chunk, &all, dt));
        let mut power = [0.0; 4];
        // Sequential, so that the bits do not depend on the number of threads.
        for chunk in &contacts.chunks {
            for (contact, dashpots) in chunk.contacts.iter().zip(&chunk.dashpots) {
                power[0] -= dashpots;
                self.friction += contact.force.friction;
            }
            self.contact_loss = chunk
                .ended
                .iter()
                .fold(self.contact_loss, |lost, stored| lost + stored);
        }
        for (body, state) in bodies.iter().zip(states) {
            if body.is_free() {
                power[1] += damping * 2.0 * kinetic(deforming, body, state)
                    + retarded_power(deforming, body, params.load_interval);
                power[3] += load_power(deforming, body, state, params.time + dt);
            } else if !body.is_fixed() {
                power[2] -= state.force.dot(state.velocity) + state.torque.dot(state.spin);
            }
        }
        for (k, power) in power.into_iter().enumerate() {
            self.work[k] += 0.5 * dt * (self.power[k] + power);
        }
        self.power = power;
    }

    /// Adds the kinetic energy (J) that a block loses when it falls asleep.
    pub fn add_sleep(&mut self, removed: f64) {
        self.work[1] += removed;
    }

    /// Sets the power of changed loads, under which the next step begins at the time `t` (s).
    pub fn reload(&mut self, all: BodyStates<'_>, t: f64) {
        let each = all.bodies.iter().zip(all.states);
        let free = each.filter(|(body, _)| body.is_free());
        self.power[3] = free
            .map(|(body, state)| load_power(all.deforming, body, state, t))
            .sum();
    }

    /// The ledger of the present state.
    pub fn ledger(
        &self,
        all: BodyStates<'_>,
        contacts: &ContactList,
        gravity: DVec3,
    ) -> EnergyLedger {
        let BodyStates {
            bodies,
            states,
            deforming,
        } = all;
        let free = || bodies.iter().zip(states).filter(|(body, _)| body.is_free());
        let strained = deforming.list.iter().zip(&deforming.strains);
        let [dashpot, mass_damping, driven, loads] = self.work;
        EnergyLedger {
            kinetic: free()
                .map(|(body, state)| kinetic(deforming, body, state))
                .sum(),
            potential: free()
                .map(|(body, state)| -body.mass * gravity.dot(state.centre))
                .sum(),
            strain: strained
                .map(|(one, strain)| one.affine.strain_energy(strain.deformation))
                .sum(),
            elastic: contacts.iter().map(|contact| contact.stored).sum(),
            friction: self.friction,
            dashpot,
            mass_damping,
            film: self.film,
            contact_loss: self.contact_loss,
            driven,
            loads,
        }
    }
}

/// Computes the work on the springs of a chunk of contacts in a step of `dt` (s), and the powers at its end.
fn work(chunk: &mut Chunk, all: &BodyStates<'_>, dt: f64) {
    chunk.dashpots.clear();
    for contact in &mut chunk.contacts {
        let force = contact.force;
        let [first, second] = contact.blocks.map(|block| block as usize);
        let velocity = all.velocity(second, contact.pressure_centre - contact.image_shift)
            - all.velocity(first, contact.pressure_centre);
        let spin = all.states[second].spin - all.states[first].spin;
        let of_face = |n: usize| {
            let (body, state) = (&all.bodies[n], &all.states[n]);
            all.deforming.face_spin(body, state, contact.normal)
        };
        let of_bond = of_face(second) - of_face(first);
        let spring =
            -force.spring.dot(velocity) - force.torsion.dot(spin) - force.bending.dot(of_bond);
        let dashpots = force.dashpot.dot(velocity) + force.moment.dot(spin);
        chunk.dashpots.push(dashpots);
        contact.stored += 0.5 * dt * (contact.power + spring) - force.friction;
        contact.power = spring;
    }
}

/// Kinetic energy of a free block, J.
fn kinetic(deforming: &DeformingBlocks, body: &Body, state: &State) -> f64 {
    match deforming.of(body) {
        None => state.kinetic(body.mass),
        Some((one, strain)) => {
            0.5 * body.mass * state.velocity.length_squared() + one.affine.kinetic(strain.rate)
        }
    }
}

/// Power that the viscous stresses of a deformable block dissipate, W.
fn retarded_power(deforming: &DeformingBlocks, body: &Body, load_interval: f64) -> f64 {
    match deforming.of(body) {
        Some((one, strain)) if load_interval > 0.0 => {
            let power = one.affine.retarded_power(strain.deformation, strain.rate);
            power * one.affine.retardation(load_interval)
        }
        _ => 0.0,
    }
}

/// Power of the load and of the applied forces on a free block at the time `t` (s), W.
fn load_power(deforming: &DeformingBlocks, body: &Body, state: &State, t: f64) -> f64 {
    let strain = deforming.of(body).map(|(_, strain)| strain);
    let turning = match strain {
        None => state.load_torque.dot(state.spin),
        Some(strain) => inner(strain.load, strain.gradient()),
    };
    let power = state.load.dot(state.velocity) + turning;
    let Some(applied_forces) = body.applied_forces() else {
        return power;
    };
    let (deformation, gradient) = match strain {
        None => (DMat3::from_quat(state.rotation), skew(state.spin)),
        Some(strain) => (strain.deformation, strain.gradient()),
    };
    let wrench = applied_forces.wrench(deformation, body.mass, t);
    power + wrench.force.dot(state.velocity) + inner(wrench.moment, gradient)
}
