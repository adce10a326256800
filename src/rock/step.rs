//! One step of all blocks: kick, drift, contacts, kick.

use super::{
    Blocks,
    body::{self, MidStep},
    contact_list::{Contact, ContactList, DISTANCES_PER_LIMIT, sum_contacts},
    deforming::StepParams,
    energy::BodyStates,
    narrowphase,
    threads::each_block,
    time_step,
};
use crate::{Error, Result, error::Overlap, rock::law};
use std::time::Instant;

/// Host times of the phases of steps, s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepTimes {
    /// Number of steps timed.
    pub steps: u64,
    /// Update of the candidate pairs.
    pub broadphase: f64,
    /// Contacts of the pairs and their forces.
    pub contact: f64,
    /// Motion, energies and sleep.
    pub integrate: f64,
}

/// Returns an error if the time `until` (s) is not finite.
pub(super) fn is_time(until: f64) -> Result<()> {
    if until.is_finite() {
        return Ok(());
    }
    let message = format!("{until} s is not a finite time; give a finite one");
    Err(Error::argument("until", message))
}

/// Length and end of one sub-step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Substep {
    /// s.
    dt: f64,
    /// Time at its end, s, if it is known more exactly than by summation.
    end: Option<f64>,
}

impl Blocks {
    /// Advances by one step of [`Blocks::time_step`].
    ///
    /// # Errors
    /// [`Error::Overlaps`] if blocks overlap at the start, [`Error::TimeStep`] if the step is too long for
    /// the contacts, [`Error::DeepOverlap`] if two blocks penetrate too deeply, [`Error::NotFinite`] if the state of a
    /// block is not finite, [`Error::Argument`] if a new list of pairs is needed first, or if a block moves by more than
    /// half its width and could pass through another one. After an error the state is that before the step.
    pub fn step(&mut self) -> Result<()> {
        self.step_by(Substep {
            dt: self.time_step,
            end: None,
        })
    }

    /// Advances by the next of the equal steps, at most as long as the time step, to the time `until`, s.
    ///
    /// # Errors
    /// The errors of [`Blocks::step`], and [`Error::Argument`] if that time is in the past.
    pub fn step_towards(&mut self, until: f64) -> Result<()> {
        is_time(until)?;
        if until < self.time {
            let message = format!("{until} s is past: the time is {} s", self.time);
            return Err(Error::argument("until", message));
        }
        self.step_by(self.substep_to(until))
    }

    /// The next of the equal steps to the time `until`, s.
    pub(super) fn substep_to(&self, until: f64) -> Substep {
        let steps = self.steps_to(until);
        Substep {
            dt: (until - self.time) / steps,
            end: (steps == 1.0).then_some(until),
        }
    }

    /// Number of equal steps of at most the time step to the time `until`, s.
    pub(crate) fn steps_to(&self, until: f64) -> f64 {
        let left = until - self.time;
        // Rounding above a whole number of steps must not add a step.
        (left / self.time_step * (1.0 - 1e-12)).ceil().max(1.0)
    }

    fn step_by(&mut self, substep: Substep) -> Result<()> {
        if self.needs_pairs() {
            let message =
                "a step needs new pairs first: find those of aabbs() and pass them to set_pairs";
            return Err(Error::argument("pairs", message));
        }
        self.step_known(substep)
    }

    /// Advances by one step, with a list of pairs that is known to be complete.
    pub(super) fn step_known(&mut self, Substep { dt, end }: Substep) -> Result<()> {
        if !dt.is_finite() {
            let message = "nothing limits the step, since no block is free; give time_step";
            return Err(Error::argument("time_step", message));
        }
        if !self.started {
            self.start()?;
        }
        let start = self.step_times.map(|times| (Instant::now(), times.contact));
        if let Err(error) = self.kick_drift(dt) {
            self.place();
            if matches!(error, Error::DeepOverlap { .. }) {
                self.check_step_of_shapes(dt)?;
            }
            return Err(error);
        }
        self.finish_step(dt);
        if let Some(end) = end {
            self.time = end;
        }
        if let (Some(times), Some((start, contact))) = (&mut self.step_times, start) {
            times.steps += 1;
            times.integrate += start.elapsed().as_secs_f64() - (times.contact - contact);
        }
        Ok(())
    }

    /// Finds the contacts before the first step.
    fn start(&mut self) -> Result<()> {
        let all = self.bodies.iter().zip(&self.states);
        self.mid_steps.clear();
        self.mid_steps
            .extend(all.map(|(body, state)| MidStep::at_start(body, state)));
        self.deforming.at_start();
        self.find_contacts(0.0, true)?;
        self.check_start(&self.next_contacts)?;
        self.check_step(self.time_step)?;
        self.next_states.clone_from(&self.states);
        self.take_over();
        for (state, sum) in self.states.iter_mut().zip(&self.contact_sums) {
            state.set_contact_forces(sum);
        }
        self.deforming
            .sum_contact_moments(&self.bodies, &self.contacts, &self.states);
        // A step of length zero records the powers at the start.
        let params = self.step_params(0.0);
        self.add_work(params);
        self.shorten_time_step();
        self.started = true;
        Ok(())
    }

    /// First kick, drift, and the contacts at the new poses.
    fn kick_drift(&mut self, dt: f64) -> Result<()> {
        let params = self.step_params(dt);
        self.film_work = self
            .films
            .first_half(&self.bodies, &self.states, &self.contacts, params);
        let films = &self.films;
        let all = each_block(&self.bodies, self.bodies.len()).zip(&self.states);
        let all = all.zip(&mut self.next_states).zip(&mut self.mid_steps);
        let not_finite = all
            .enumerate()
            .filter_map(|(i, (((body, state), next), mid_step))| {
                *next = *state;
                *mid_step = body::kick_drift(body, next, films.push(i), params);
                (!next.is_finite()).then_some(i)
            });
        let not_finite = not_finite.min();
        let unsound = self.deforming.kick_drift(
            &self.bodies,
            &self.states,
            params,
            &mut self.next_states,
            &mut self.mid_steps,
        );
        if let Some(bad) = not_finite.into_iter().chain(unsound).min() {
            return Err(self.not_finite(bad, self.time + dt));
        }
        self.check_tunnelling(dt)?;
        let strains = &self.deforming.next;
        self.parts
            .place_moving(&self.bodies, &self.next_states, strains);
        let start = self.step_times.map(|_| Instant::now());
        self.find_contacts(dt, false)?;
        if let (Some(times), Some(start)) = (&mut self.step_times, start) {
            times.contact += start.elapsed().as_secs_f64();
        }
        self.check_step(dt)
    }

    /// Completes an accepted step: forces, second kick, energies, sleep.
    fn finish_step(&mut self, dt: f64) {
        self.take_over();
        let (gravity, sleep, params) = (self.gravity, self.sleep, self.step_params(dt));
        self.films
            .before_second_half(&self.bodies, &self.states, &self.contacts);
        let all = each_block(&self.bodies, self.bodies.len()).zip(&self.contact_sums);
        all.zip(&mut self.states).for_each(|((body, sum), state)| {
            state.set_contact_forces(sum);
            if let Some(sleep) = &sleep {
                state.wake(body, sleep, gravity);
            }
            body::second_kick(body, state, params);
        });
        self.deforming
            .sum_contact_moments(&self.bodies, &self.contacts, &self.states);
        self.deforming
            .second_kick(&self.bodies, params, &mut self.states);
        self.film_work += self.films.second_half(&self.bodies, &mut self.states);
        if let Some(delay) = self.film.as_ref().and_then(|film| film.delay) {
            let moving = self.bodies.iter().zip(&mut self.states);
            let moving = moving.filter(|(body, _)| !body.is_fixed());
            moving.for_each(|(_, state)| state.update_mean(delay.memory, dt));
        }
        self.wake_by_films();
        self.work_sums.film += self.film_work;
        self.add_work(params);
        if let Some(sleep) = &sleep {
            for (body, state) in self.bodies.iter().zip(&mut self.states) {
                if body.may_sleep() {
                    self.work_sums
                        .add_sleep(state.update_sleep(body, sleep, dt));
                }
            }
        }
        let speeds = self.states.iter().map(|state| state.velocity.length());
        self.peak_speed = speeds.fold(self.peak_speed, f64::max);
        self.time += dt;
        self.steps += 1;
        self.shorten_time_step();
    }

    /// Accepts the trial state.
    fn take_over(&mut self) {
        std::mem::swap(&mut self.states, &mut self.next_states);
        std::mem::swap(&mut self.pairs, &mut self.next_pairs);
        std::mem::swap(&mut self.contacts, &mut self.next_contacts);
        let deforming = &mut self.deforming;
        std::mem::swap(&mut deforming.strains, &mut deforming.next);
    }

    /// Parameters of a step of `dt` (s) from now.
    fn step_params(&self, dt: f64) -> StepParams {
        StepParams {
            gravity: self.gravity,
            damping: self.damping,
            load_interval: self.load_interval,
            time: self.time,
            dt,
        }
    }

    /// Adds the work of an accepted step.
    fn add_work(&mut self, params: StepParams) {
        let all = BodyStates {
            bodies: &self.bodies,
            states: &self.states,
            deforming: &self.deforming,
        };
        self.work_sums.add_step(all, &mut self.contacts, params);
    }

    /// Wakes the sleeping blocks on which films act.
    fn wake_by_films(&mut self) {
        let Some(sleep) = self.sleep else {
            return;
        };
        for &(block, force) in &self.films.forces {
            let state = &mut self.states[block as usize];
            let weight = self.bodies[block as usize].mass * self.gravity.length();
            if state.asleep && force.length() > sleep.change * weight {
                (state.asleep, state.slow) = (false, 0.0);
            }
        }
    }

    /// Places all parts at the poses of their blocks.
    pub(super) fn place(&mut self) {
        self.parts
            .place_all(&self.bodies, &self.states, &self.deforming.strains);
    }

    /// The error of a block whose state at `time` (s) is not finite, or that is inverted.
    pub(super) fn not_finite(&self, number: usize, time: f64) -> Error {
        let strain = self.deforming.of_next(&self.bodies[number]);
        let crushed = strain.is_some_and(|strain| strain.deformation.determinant() <= 0.0);
        let block = self.label(number);
        if crushed {
            return Error::Inverted { block, time };
        }
        let remedy = match self.bodies[number].undefined_at(time) {
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

    /// Wakes the sleeping blocks whose load has changed.
    pub(super) fn wake(&mut self) {
        let Some(sleep) = self.sleep else {
            return;
        };
        for (body, state) in self.bodies.iter().zip(&mut self.states) {
            state.wake(body, &sleep, self.gravity);
        }
    }

    /// Finds the contacts of all pairs at the trial poses, and their sums. With `bonding`, at the start, faces that touch
    /// are bonded and overlaps are not limited.
    fn find_contacts(&mut self, dt: f64, bonding: bool) -> Result<()> {
        let narrowphase = narrowphase::Narrowphase {
            bodies: &self.bodies,
            mid_steps: &self.mid_steps,
            deforming: &self.deforming,
            parts: &self.parts,
            joints: &self.joints,
            contacts: &self.contacts,
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
        narrowphase::resolve(
            &narrowphase,
            &mut self.resolver_pool,
            &self.pairs,
            &mut self.next_pairs,
            &mut self.next_contacts,
        )?;
        sum_contacts(
            &self.next_contacts,
            &self.bodies,
            &self.deforming,
            &self.mid_steps,
            &self.joints,
            &mut self.contact_sums,
        );
        Ok(())
    }

    fn check_start(&self, contacts: &ContactList) -> Result<()> {
        let most = |contact: &Contact| DISTANCES_PER_LIMIT * self.start_overlap * contact.limit;
        let mut deep: Vec<_> = contacts.iter().filter(|t| t.overlap > most(t)).collect();
        if deep.is_empty() {
            return Ok(());
        }
        deep.sort_by(|a, b| b.overlap.total_cmp(&a.overlap));
        let overlap = |contact: &&Contact| Overlap {
            first: self.label(contact.blocks[0] as usize),
            second: self.label(contact.blocks[1] as usize),
            depth: contact.overlap,
        };
        Err(Error::Overlaps {
            pairs: deep.iter().map(overlap).collect(),
        })
    }

    /// Returns an error if a prescribed step is too long for the contacts or for a deformable block.
    fn check_step(&self, dt: f64) -> Result<()> {
        if !self.given_step {
            return Ok(());
        }
        let stiffest = time_step::of_sums(&self.bodies, &self.deforming, &self.contact_sums);
        self.check_step_for(dt, stiffest)
    }

    /// The same for the faces of the shapes: a step too long for contacts may fail before there are any.
    pub(super) fn check_step_of_shapes(&self, dt: f64) -> Result<()> {
        match self.given_step {
            true => self.check_step_for(dt, self.stiffest),
            false => Ok(()),
        }
    }

    /// The same for ω² and the index of the stiffest block.
    fn check_step_for(&self, dt: f64, (frequency_squared, block): (f64, usize)) -> Result<()> {
        let bound = law::longest_step(law::LARGEST_SHARE, frequency_squared);
        if dt <= bound {
            return Ok(());
        }
        Err(Error::TimeStep {
            requested: dt,
            bound,
            usual: law::longest_step(law::USUAL_SHARE, frequency_squared),
            block: self.label(block),
        })
    }

    /// Limits a step that is not prescribed to the usual bound of the present contacts.
    fn shorten_time_step(&mut self) {
        if self.given_step {
            return;
        }
        let (frequency_squared, _) =
            time_step::of_sums(&self.bodies, &self.deforming, &self.contact_sums);
        let usual = law::longest_step(law::USUAL_SHARE, frequency_squared);
        self.time_step = self.time_step.min(usual);
    }
}
