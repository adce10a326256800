//! Keeping the energy ledger: works by the trapezoidal rule over a step, as velocity Verlet has them.

use super::{
    Body, Ledger,
    body::State,
    deforming::{DeformingBlocks, Under},
    touches::{Chunk, Touches},
};
use crate::{geometry::skew, rock::law::inner};
use glam::{DMat3, DVec3};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Chunks of contacts that one thread takes at least.
const FEW: usize = 8;

/// Sums since the start, J, and the powers at the end of the last step, W.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Books {
    pub friction: f64,
    pub lost: f64,
    pub film: f64,
    /// Of the dashpots, the mass damping, the drives and the loads.
    pub work: [f64; 4],
    pub power: [f64; 4],
}

/// All blocks and their state.
#[derive(Clone, Copy, Debug)]
pub(super) struct All<'a> {
    pub bodies: &'a [Body],
    pub states: &'a [State],
    pub deforming: &'a DeformingBlocks,
}

impl All<'_> {
    /// Velocity of a block where it is at `at` (m), m/s.
    fn velocity(&self, block: usize, at: DVec3) -> DVec3 {
        let state = &self.states[block];
        let r = at - state.centre;
        // Among rigid blocks alone nobody looks into the bodies, which are far away in memory.
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

impl Books {
    /// Books the step `under` at whose end the contacts are `touches`, with the velocities there.
    pub fn step(&mut self, all: All<'_>, touches: &mut Touches, under: Under) {
        let All {
            bodies,
            states,
            deforming,
        } = all;
        let (damping, dt) = (under.damping, under.dt);
        let chunks = touches.chunks.par_iter_mut().with_min_len(FEW);
        chunks.for_each(|chunk| work(chunk, &all, dt));
        let mut power = [0.0; 4];
        // One after the other: the bits must not depend on the number of threads.
        for chunk in &touches.chunks {
            for (touch, dashpots) in chunk.touches.iter().zip(&chunk.dashpots) {
                power[0] -= dashpots;
                self.friction += touch.force.friction;
            }
            self.lost = chunk.ended.iter().fold(self.lost, |lost, held| lost + held);
        }
        for (body, state) in bodies.iter().zip(states) {
            if body.is_free() {
                power[1] += damping * 2.0 * kinetic(deforming, body, state);
                power[3] += load_power(deforming, body, state, under.time + dt);
            } else if !body.is_fixed() {
                power[2] -= state.force.dot(state.velocity) + state.torque.dot(state.spin);
            }
        }
        for (k, power) in power.into_iter().enumerate() {
            self.work[k] += 0.5 * dt * (self.power[k] + power);
        }
        self.power = power;
    }

    /// Takes new loads over: the next step begins under them at the time `t` (s).
    pub fn reload(&mut self, all: All<'_>, t: f64) {
        let each = all.bodies.iter().zip(all.states);
        let free = each.filter(|(body, _)| body.is_free());
        self.power[3] = free
            .map(|(body, state)| load_power(all.deforming, body, state, t))
            .sum();
    }

    /// The ledger of the present state.
    pub fn ledger(&self, all: All<'_>, touches: &Touches, gravity: DVec3) -> Ledger {
        let All {
            bodies,
            states,
            deforming,
        } = all;
        let free = || bodies.iter().zip(states).filter(|(body, _)| body.is_free());
        let strained = deforming.list.iter().zip(&deforming.strains);
        let [dashpot, mass_damping, driven, loads] = self.work;
        Ledger {
            kinetic: free()
                .map(|(body, state)| kinetic(deforming, body, state))
                .sum(),
            potential: free()
                .map(|(body, state)| -body.mass * gravity.dot(state.centre))
                .sum(),
            strain: strained
                .map(|(one, strain)| one.affine.strain_energy(strain.deformation))
                .sum(),
            elastic: touches.iter().map(|touch| touch.stored).sum(),
            friction: self.friction,
            dashpot,
            mass_damping,
            film: self.film,
            lost: self.lost,
            driven,
            loads,
        }
    }
}

/// Works on the springs of some contacts in a step of `dt` (s), and the powers at its end.
fn work(chunk: &mut Chunk, all: &All<'_>, dt: f64) {
    chunk.dashpots.clear();
    for touch in &mut chunk.touches {
        let force = touch.force;
        let [first, second] = touch.blocks.map(|block| block as usize);
        let velocity = all.velocity(second, touch.pressure_centre - touch.way)
            - all.velocity(first, touch.pressure_centre);
        let spin = all.states[second].spin - all.states[first].spin;
        let spring = -force.spring.dot(velocity) - force.bending.dot(spin);
        let dashpots = force.dashpot.dot(velocity) + force.moment.dot(spin);
        chunk.dashpots.push(dashpots);
        touch.stored += 0.5 * dt * (touch.power + spring) - force.friction;
        touch.power = spring;
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

/// What the load on a free block, and what acts on it alone, do a second at the time `t` (s), W.
fn load_power(deforming: &DeformingBlocks, body: &Body, state: &State, t: f64) -> f64 {
    let strain = deforming.of(body).map(|(_, strain)| strain);
    let turning = match strain {
        None => state.load_torque.dot(state.spin),
        Some(strain) => inner(strain.load, strain.gradient()),
    };
    let power = state.load.dot(state.velocity) + turning;
    let Some(acting) = body.acting() else {
        return power;
    };
    let (deformation, gradient) = match strain {
        None => (DMat3::from_quat(state.rotation), skew(state.spin)),
        Some(strain) => (strain.deformation, strain.gradient()),
    };
    let pull = acting.pull(deformation, body.mass, t);
    power + pull.force.dot(state.velocity) + inner(pull.moment, gradient)
}
