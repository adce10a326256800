//! One step of all blocks: kick, drift, contacts, kick.

use super::{
    Blocks,
    body::{self, Flight},
    books::All,
    bound,
    deforming::Under,
    narrow, sums,
    touch::{TENTHS, Touch},
    touches::Touches,
};
use crate::{Error, Result, error::Overlap, rock::law};
use rayon::prelude::*;

/// Blocks that one thread takes at least: handing out fewer costs more.
pub(super) const FEW: usize = 256;

/// Whether `until` is a time (s) to go to.
pub(super) fn is_time(until: f64) -> Result<()> {
    if until.is_finite() {
        return Ok(());
    }
    let message = format!("{until} s is no time to go to; give a finite one");
    Err(Error::argument("until", message))
}

/// What a step leads to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stride {
    /// s.
    dt: f64,
    /// Time at its end, where it is known better than by adding up, s.
    end: Option<f64>,
}

impl Blocks {
    /// One step of [`Blocks::time_step`].
    ///
    /// # Errors
    /// [`Error::Overlaps`] if blocks overlap at the start, [`Error::TimeStep`] if the step is too long for
    /// the contacts, [`Error::DeepOverlap`] if two blocks are pressed into each other,
    /// [`Error::NotFinite`] if a block is nowhere, [`Error::Argument`] if pairs are wanted first, or if a block moves by more
    /// than half its width, so that it could pass through others unseen. After an error everything is as it was before
    /// the step.
    pub fn step(&mut self) -> Result<()> {
        self.step_by(Stride {
            dt: self.time_step,
            end: None,
        })
    }

    /// One of the equal steps that lead to the time `until`, s, none longer than the time step.
    ///
    /// # Errors
    /// Those of [`Blocks::step`], and [`Error::Argument`] if that time is past.
    pub fn step_towards(&mut self, until: f64) -> Result<()> {
        is_time(until)?;
        if until < self.time {
            let message = format!("{until} s is past: the time is {} s", self.time);
            return Err(Error::argument("until", message));
        }
        self.step_by(self.stride(until))
    }

    /// The next of the equal steps to the time `until`, s.
    pub(super) fn stride(&self, until: f64) -> Stride {
        let steps = self.steps_to(until);
        Stride {
            dt: (until - self.time) / steps,
            end: (steps == 1.0).then_some(until),
        }
    }

    /// Equal steps of at most the time step that lead to the time `until`, s.
    pub(crate) fn steps_to(&self, until: f64) -> f64 {
        let left = until - self.time;
        // What rounding adds to a whole number of steps makes no step of its own.
        (left / self.time_step * (1.0 - 1e-12)).ceil().max(1.0)
    }

    fn step_by(&mut self, stride: Stride) -> Result<()> {
        if self.wants_pairs() {
            let message =
                "a step wants pairs first: find those of items() and give them to set_pairs";
            return Err(Error::argument("pairs", message));
        }
        self.step_known(stride)
    }

    /// A step of whose pairs it is known that they are all there.
    pub(super) fn step_known(&mut self, Stride { dt, end }: Stride) -> Result<()> {
        if !dt.is_finite() {
            let message = "nothing limits the step, since no block is free; give time_step";
            return Err(Error::argument("time_step", message));
        }
        if !self.started {
            self.start()?;
        }
        if let Err(error) = self.fly(dt) {
            self.place();
            return Err(error);
        }
        self.land(dt);
        if let Some(end) = end {
            self.time = end;
        }
        Ok(())
    }

    /// Finds the contacts of the first step.
    fn start(&mut self) -> Result<()> {
        let all = self.bodies.iter().zip(&self.states);
        self.flights.clear();
        self.flights
            .extend(all.map(|(body, state)| Flight::at_start(body, state)));
        self.deforming.at_start();
        self.find_contacts(0.0, true)?;
        self.check_start(&self.next_touches)?;
        self.check_step(self.time_step)?;
        self.next_states.clone_from(&self.states);
        self.take_over();
        for (state, sum) in self.states.iter_mut().zip(&self.sums) {
            state.pull(sum);
        }
        self.deforming
            .pull(&self.bodies, &self.touches, &self.states);
        // A step of no length books the powers at the start.
        let under = self.under(0.0);
        self.book(under);
        self.shorten();
        self.started = true;
        Ok(())
    }

    /// Kick, drift and the contacts there.
    fn fly(&mut self, dt: f64) -> Result<()> {
        let under = self.under(dt);
        self.filmed = self
            .films
            .first_half((&self.bodies, &self.states), &self.touches, under);
        let films = &self.films;
        let all = self.bodies.par_iter().zip(&self.states);
        let ends = self.next_states.par_iter_mut().zip(&mut self.flights);
        let all = all.zip(ends).enumerate().with_min_len(FEW);
        let lost = all.filter_map(|(i, ((body, state), (next, flight)))| {
            *next = *state;
            *flight = body::fly(body, next, films.push(i), under);
            (!next.is_finite()).then_some(i)
        });
        let lost = lost.min();
        let unsound = self.deforming.fly(
            &self.bodies,
            &self.states,
            under,
            &mut self.next_states,
            &mut self.flights,
        );
        if let Some(bad) = lost.into_iter().chain(unsound).min() {
            return Err(self.lost(bad, self.time + dt));
        }
        self.check_ways(dt)?;
        let strains = &self.deforming.next;
        self.parts.follow(&self.bodies, &self.next_states, strains);
        self.find_contacts(dt, false)?;
        self.check_step(dt)
    }

    /// Takes the step over: forces, second kick, energies, sleep.
    fn land(&mut self, dt: f64) {
        self.take_over();
        let (gravity, sleep, under) = (self.gravity, self.sleep, self.under(dt));
        self.films
            .before_second_half((&self.bodies, &self.states), &self.touches);
        let all = self.bodies.par_iter().zip(&self.sums);
        let all = all.zip(&mut self.states).with_min_len(FEW);
        all.for_each(|((body, sum), state)| {
            state.pull(sum);
            if let Some(sleep) = &sleep {
                state.wake(body, sleep, gravity);
            }
            body::land(body, state, under);
        });
        self.deforming
            .pull(&self.bodies, &self.touches, &self.states);
        self.deforming.land(&self.bodies, under, &mut self.states);
        self.filmed += self.films.second_half(&self.bodies, &mut self.states);
        self.stir();
        self.books.film += self.filmed;
        self.book(under);
        if let Some(sleep) = &sleep {
            for (body, state) in self.bodies.iter().zip(&mut self.states) {
                if body.may_sleep() {
                    state.drowse(body, sleep, dt);
                }
            }
        }
        self.time += dt;
        self.steps += 1;
        self.shorten();
    }

    /// What was written becomes what is.
    fn take_over(&mut self) {
        std::mem::swap(&mut self.states, &mut self.next_states);
        std::mem::swap(&mut self.pairs, &mut self.next_pairs);
        std::mem::swap(&mut self.touches, &mut self.next_touches);
        let deforming = &mut self.deforming;
        std::mem::swap(&mut deforming.strains, &mut deforming.next);
    }

    /// A step of `dt` (s) from now.
    fn under(&self, dt: f64) -> Under {
        Under {
            gravity: self.gravity,
            damping: self.damping,
            time: self.time,
            dt,
        }
    }

    /// Books a step that has been taken over.
    fn book(&mut self, under: Under) {
        let all = All {
            bodies: &self.bodies,
            states: &self.states,
            deforming: &self.deforming,
        };
        self.books.step(all, &mut self.touches, under);
    }

    /// Wakes the sleepers that films push at.
    fn stir(&mut self) {
        let Some(sleep) = self.sleep else {
            return;
        };
        for (block, force) in self.films.forces() {
            let state = &mut self.states[block];
            let weight = self.bodies[block].mass * self.gravity.length();
            if state.asleep && force.length() > sleep.change * weight {
                (state.asleep, state.slow) = (false, 0.0);
            }
        }
    }

    /// Puts all parts where their blocks are.
    pub(super) fn place(&mut self) {
        self.parts
            .put(&self.bodies, &self.states, &self.deforming.strains);
    }

    /// Why a block has no pose at `time` (s).
    fn lost(&self, number: usize, time: f64) -> Error {
        let strain = self.deforming.of_next(&self.bodies[number]);
        let crushed = strain.is_some_and(|strain| strain.deformation.determinant() <= 0.0);
        let block = self.label(number);
        if crushed {
            return Error::Inverted { block, time };
        }
        let remedy = match self.bodies[number].undriven_at(time) {
            Some(formula) => format!(
                "its formula `{formula}` has no finite value there; give one that has at all times of the run"
            ),
            None => {
                "look at its load, its drive and its contacts; a shorter time_step may help".into()
            }
        };
        Error::NotFinite {
            block,
            time,
            remedy,
        }
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

    /// The contacts of all pairs where the blocks have flown to, and their sums. Those of the start are
    /// bonded, and as deep as they are.
    fn find_contacts(&mut self, dt: f64, bonding: bool) -> Result<()> {
        let scene = narrow::Scene {
            bodies: &self.bodies,
            flights: &self.flights,
            deforming: &self.deforming,
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
            corner_area: self.corner_area,
            film: self.film.as_ref(),
            periods: self.periods.as_ref(),
        };
        narrow::resolve(
            &scene,
            &mut self.resolvers,
            &self.pairs,
            &mut self.next_pairs,
            &mut self.next_touches,
        )?;
        sums::of_touches(
            &self.next_touches,
            (&self.bodies, &self.deforming),
            &self.flights,
            &self.joints,
            &mut self.sums,
        );
        Ok(())
    }

    fn check_start(&self, touches: &Touches) -> Result<()> {
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

    /// Refuses a given step that is too long for the contacts, or for a block that deforms.
    fn check_step(&self, dt: f64) -> Result<()> {
        if !self.given_step {
            return Ok(());
        }
        let (frequency_squared, block) = bound::of_sums(&self.bodies, &self.deforming, &self.sums);
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
        let (frequency_squared, _) = bound::of_sums(&self.bodies, &self.deforming, &self.sums);
        let usual = law::longest_step(law::USUAL_SHARE, frequency_squared);
        self.time_step = self.time_step.min(usual);
    }
}
