//! One step of all blocks: kick, drift, contacts, kick.

use super::{
    Blocks, Body, Pose,
    body::{self, Flight, State},
    bound, narrow,
    parts::place,
    touch::{TENTHS, Touch},
};
use crate::{Error, Result, error::Overlap, law};
use glam::DVec3;
use rayon::prelude::*;

/// Fewer blocks than this are moved by one thread: handing out costs more.
const FEW: usize = 512;

impl Blocks {
    /// One step of [`Blocks::time_step`].
    ///
    /// # Errors
    /// [`Error::Overlaps`] if blocks overlap at the start, [`Error::TimeStep`] if the step is too long for
    /// the contacts, [`Error::DeepOverlap`] if two blocks are pressed into each other,
    /// [`Error::NotFinite`] if a block is nowhere, [`Error::Scene`] if pairs are wanted first. After an
    /// error everything is as it was before the step.
    pub fn step(&mut self) -> Result<()> {
        self.step_by(self.time_step)
    }

    /// One of the equal steps that lead to the time `until`, s, none longer than the time step.
    ///
    /// # Errors
    /// Those of [`Blocks::step`].
    pub fn step_towards(&mut self, until: f64) -> Result<()> {
        let left = until - self.time;
        // What rounding adds to a whole number of steps makes no step of its own.
        let steps = (left / self.time_step * (1.0 - 1e-12)).ceil().max(1.0);
        self.step_by(left / steps)?;
        if steps == 1.0 {
            self.time = until;
        }
        Ok(())
    }

    fn step_by(&mut self, dt: f64) -> Result<()> {
        if self.wants_pairs() {
            let message =
                "a step wants pairs first: find those of items() and give them to set_pairs";
            return Err(Error::scene("pairs", message));
        }
        if !dt.is_finite() {
            let message = "nothing limits the step, since no block is free; give time_step";
            return Err(Error::scene("time_step", message));
        }
        if !self.started {
            self.start()?;
        }
        self.before.clone_from(&self.states);
        let touches = self.fly(dt);
        match touches {
            Ok(touches) => {
                self.land(touches, dt);
                Ok(())
            }
            Err(error) => {
                std::mem::swap(&mut self.states, &mut self.before);
                self.place(|_| true);
                Err(error)
            }
        }
    }

    /// Finds the contacts of the first step.
    fn start(&mut self) -> Result<()> {
        self.flights.clear();
        let flight = |state: &State| Flight {
            end_velocity: state.velocity,
            end_spin: state.spin,
            ..Flight::default()
        };
        self.flights.extend(self.states.iter().map(flight));
        let touches = self.contacts_after(0.0, true)?;
        self.check_start(&touches)?;
        self.check_step(&touches, self.time_step)?;
        std::mem::swap(&mut self.pairs, &mut self.next_pairs);
        self.touches = touches;
        self.sum_forces();
        // A step of no length books the powers at the start.
        self.books.step(
            &self.bodies,
            &self.states,
            &mut self.touches,
            self.damping,
            0.0,
        );
        self.shorten();
        self.started = true;
        Ok(())
    }

    /// Kick, drift and the contacts there.
    fn fly(&mut self, dt: f64) -> Result<Vec<Touch>> {
        let (gravity, damping, time) = (self.gravity, self.damping, self.time);
        let fly =
            |body: &Body, state: &mut State| body::fly(body, state, gravity, damping, time, dt);
        let (bodies, states) = (&self.bodies, &mut self.states);
        if bodies.len() < FEW {
            self.flights.clear();
            let all = bodies.iter().zip(states);
            self.flights
                .extend(all.map(|(body, state)| fly(body, state)));
        } else {
            let all = bodies.par_iter().zip(states);
            all.map(|(body, state)| fly(body, state))
                .collect_into_vec(&mut self.flights);
        }
        if let Some(bad) = self.states.iter().position(|state| !state.is_finite()) {
            return Err(Error::NotFinite {
                block: self.label(bad),
                time: time + dt,
                remedy:
                    "look at its load, its drive and its contacts; a shorter time_step may help"
                        .into(),
            });
        }
        self.place_moved();
        let touches = self.contacts_after(dt, false)?;
        self.check_step(&touches, dt)?;
        Ok(touches)
    }

    /// Takes the step over: forces, second kick, energies, sleep.
    fn land(&mut self, mut touches: Vec<Touch>, dt: f64) {
        let (gravity, damping) = (self.gravity, self.damping);
        std::mem::swap(&mut self.pairs, &mut self.next_pairs);
        std::mem::swap(&mut self.touches, &mut touches);
        self.sum_forces();
        self.wake();
        for (body, state) in self.bodies.iter().zip(&mut self.states) {
            body::land(body, state, gravity, damping, dt);
        }
        self.books
            .step(&self.bodies, &self.states, &mut self.touches, damping, dt);
        self.books.end(&touches, &self.pairs, &self.next_pairs, dt);
        if let Some(sleep) = self.sleep {
            for (body, state) in self.bodies.iter().zip(&mut self.states) {
                if body.is_free() {
                    state.drowse(body, &sleep, dt);
                }
            }
        }
        self.time += dt;
        self.steps += 1;
        self.shorten();
    }

    /// Wakes the sleepers that something new pulls at.
    pub(super) fn wake(&mut self) {
        let Some(sleep) = self.sleep else {
            return;
        };
        for (body, state) in self.bodies.iter().zip(&mut self.states) {
            state.wake(body, &sleep, self.gravity);
        }
    }

    /// The contacts of all pairs, into `next_pairs`. Those of the start are bonded, and as deep as they are.
    fn contacts_after(&mut self, dt: f64, bonding: bool) -> Result<Vec<Touch>> {
        self.next_pairs.clone_from(&self.pairs);
        let scene = narrow::Scene {
            bodies: &self.bodies,
            states: &self.states,
            flights: &self.flights,
            parts: &self.parts,
            joints: &self.joints,
            touches: &self.touches,
            time_step: dt,
            bonding,
            largest_overlap: if bonding {
                f64::INFINITY
            } else {
                self.largest_overlap
            },
        };
        narrow::resolve(&scene, &mut self.resolvers, &mut self.next_pairs)
    }

    fn place_moved(&mut self) {
        let moved = |body: &Body, state: &State| !body.is_fixed() && !state.asleep;
        if self.bodies.len() < FEW {
            let places: Vec<bool> = {
                let all = self.bodies.iter().zip(&self.states);
                all.map(|(body, state)| moved(body, state)).collect()
            };
            self.place(|i| places[i]);
            return;
        }
        // Parts of different blocks are different slices of one list.
        let mut rest = self.parts.placed.as_mut_slice();
        let mut work = Vec::with_capacity(self.bodies.len());
        for (body, state) in self.bodies.iter().zip(&self.states) {
            let (own, others) = rest.split_at_mut(body.parts.len());
            rest = others;
            if moved(body, state) {
                work.push((body, state, own));
            }
        }
        work.into_par_iter().for_each(|(body, state, own)| {
            let pose: Pose = state.pose();
            place(body, &pose, own);
        });
    }

    /// Net force and torque of each block, in the order of the contacts.
    fn sum_forces(&mut self) {
        for state in &mut self.states {
            (state.force, state.torque) = (DVec3::ZERO, DVec3::ZERO);
        }
        for touch in &self.touches {
            let [a, b] = touch.blocks.map(|block| block as usize);
            let (force, moment) = (touch.force.total(), touch.force.moment);
            for (block, force, moment) in [(a, -force, -moment), (b, force, moment)] {
                let state = &mut self.states[block];
                let arm = touch.pressure_centre - state.centre;
                state.force += force;
                state.torque += arm.cross(force) + moment;
            }
        }
    }

    fn check_start(&self, touches: &[Touch]) -> Result<()> {
        let most = |touch: &Touch| TENTHS * self.start_overlap * touch.limit;
        let mut deep: Vec<_> = touches.iter().filter(|t| t.overlap > most(t)).collect();
        if deep.is_empty() {
            return Ok(());
        }
        deep.sort_by(|a, b| b.overlap.total_cmp(&a.overlap));
        let overlap = |touch: &&Touch| Overlap {
            first: self.label(touch.blocks[0] as usize),
            second: self.label(touch.blocks[1] as usize),
            depth: touch.overlap,
        };
        Err(Error::Overlaps {
            pairs: deep.iter().map(overlap).collect(),
        })
    }

    /// Refuses a given step that is too long for the contacts.
    fn check_step(&mut self, touches: &[Touch], dt: f64) -> Result<()> {
        if !self.given_step {
            return Ok(());
        }
        let (frequency_squared, block) = bound::of_touches(
            &self.bodies,
            &self.states,
            touches,
            &self.joints,
            &mut self.sums,
        );
        let bound = law::longest_step(law::LARGEST_SHARE, frequency_squared);
        if dt <= bound {
            return Ok(());
        }
        Err(Error::TimeStep {
            asked: dt,
            bound,
            usual: law::longest_step(law::USUAL_SHARE, frequency_squared),
            block: self.label(block),
        })
    }

    /// Keeps a step that was not given within the usual bound of the present contacts.
    fn shorten(&mut self) {
        if self.given_step {
            return;
        }
        let (frequency_squared, _) = bound::of_touches(
            &self.bodies,
            &self.states,
            &self.touches,
            &self.joints,
            &mut self.sums,
        );
        let usual = law::longest_step(law::USUAL_SHARE, frequency_squared);
        self.time_step = self.time_step.min(usual);
    }
}
