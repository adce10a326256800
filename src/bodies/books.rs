//! Keeping the energy ledger: works by the trapezoidal rule over a step, as velocity Verlet has them.

use super::{
    Body, Ledger,
    body::State,
    touches::{Chunk, Touches},
};
use glam::DVec3;
use rayon::prelude::*;

/// Chunks of contacts that one thread takes at least.
const FEW: usize = 8;

/// Sums since the start, J, and the powers at the end of the last step, W.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Books {
    pub friction: f64,
    pub lost: f64,
    /// Of the dashpots, the mass damping, the drives and the loads.
    pub work: [f64; 4],
    pub power: [f64; 4],
}

impl Books {
    /// Books a step of `dt` (s) at whose end the contacts are `touches`, with the velocities there.
    pub fn step(
        &mut self,
        bodies: &[Body],
        states: &[State],
        touches: &mut Touches,
        damping: f64,
        dt: f64,
    ) {
        let chunks = touches.chunks.par_iter_mut().with_min_len(FEW);
        chunks.for_each(|chunk| work(chunk, states, dt));
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
            let loaded = state.load != DVec3::ZERO || state.load_torque != DVec3::ZERO;
            if body.is_free() {
                let twice =
                    body.mass * state.velocity.length_squared() + state.momentum.dot(state.spin);
                power[1] += damping * twice;
                if loaded {
                    power[3] += load_power(state);
                }
            } else if !body.is_fixed() {
                power[2] -= state.force.dot(state.velocity) + state.torque.dot(state.spin);
            }
        }
        for (k, power) in power.into_iter().enumerate() {
            self.work[k] += 0.5 * dt * (self.power[k] + power);
        }
        self.power = power;
    }

    /// Takes new loads over: the next step begins under them.
    pub fn reload(&mut self, bodies: &[Body], states: &[State]) {
        let free = bodies.iter().zip(states).filter(|(body, _)| body.is_free());
        self.power[3] = free.map(|(_, state)| load_power(state)).sum();
    }

    /// The ledger of the present state.
    pub fn ledger(
        &self,
        bodies: &[Body],
        states: &[State],
        touches: &Touches,
        gravity: DVec3,
    ) -> Ledger {
        let free = || bodies.iter().zip(states).filter(|(body, _)| body.is_free());
        let [dashpot, mass_damping, driven, loads] = self.work;
        Ledger {
            kinetic: free().map(|(body, state)| state.kinetic(body.mass)).sum(),
            potential: free()
                .map(|(body, state)| -body.mass * gravity.dot(state.centre))
                .sum(),
            elastic: touches.iter().map(|touch| touch.stored).sum(),
            friction: self.friction,
            dashpot,
            mass_damping,
            lost: self.lost,
            driven,
            loads,
        }
    }
}

/// Works on the springs of some contacts in a step of `dt` (s), and the powers at its end.
fn work(chunk: &mut Chunk, states: &[State], dt: f64) {
    chunk.dashpots.clear();
    for touch in &mut chunk.touches {
        let force = touch.force;
        let [first, second] = touch.blocks.map(|block| &states[block as usize]);
        let [ra, rb] = [first, second].map(|state| touch.pressure_centre - state.centre);
        let velocity =
            second.velocity + second.spin.cross(rb) - first.velocity - first.spin.cross(ra);
        let spin = second.spin - first.spin;
        let spring = -force.spring.dot(velocity);
        let dashpots = force.dashpot.dot(velocity) + force.moment.dot(spin);
        chunk.dashpots.push(dashpots);
        touch.stored += 0.5 * dt * (touch.power + spring) - force.friction;
        touch.power = spring;
    }
}

/// What the load on a block does a second, W.
fn load_power(state: &State) -> f64 {
    state.load.dot(state.velocity) + state.load_torque.dot(state.spin)
}
