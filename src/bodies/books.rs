//! Keeping the energy ledger: works by the trapezoidal rule over a step, as velocity Verlet has them.

use super::{
    Body, Ledger,
    body::State,
    touch::{NONE, Pair, Touch},
};
use glam::DVec3;

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
        touches: &mut [Touch],
        damping: f64,
        dt: f64,
    ) {
        let mut power = [0.0; 4];
        for touch in touches.iter_mut() {
            let force = touch.force;
            let [first, second] = touch.blocks.map(|block| &states[block as usize]);
            let [ra, rb] = [first, second].map(|state| touch.pressure_centre - state.centre);
            let velocity =
                second.velocity + second.spin.cross(rb) - first.velocity - first.spin.cross(ra);
            let spin = second.spin - first.spin;
            let spring = -force.spring.dot(velocity);
            power[0] -= force.dashpot.dot(velocity) + force.moment.dot(spin);
            touch.stored += 0.5 * dt * (touch.power + spring) - force.friction;
            touch.power = spring;
            self.friction += force.friction;
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

    /// Books the contacts of `old` that are no more: their force acted for half a step yet.
    pub fn end(&mut self, old: &[Touch], pairs: &[Pair], before: &[Pair], dt: f64) {
        for (now, was) in pairs.iter().zip(before) {
            if was.touch != NONE && now.touch == NONE {
                let touch = &old[was.touch as usize];
                self.lost += touch.stored + 0.5 * dt * touch.power;
            }
        }
    }

    /// The ledger of the present state.
    pub fn ledger(
        &self,
        bodies: &[Body],
        states: &[State],
        touches: &[Touch],
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

/// What the load on a block does a second, W.
fn load_power(state: &State) -> f64 {
    state.load.dot(state.velocity) + state.load_torque.dot(state.spin)
}
