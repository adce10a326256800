//! Films of fluid between blocks that nearly touch, which resist the closing, opening and tilting of the gap.
//!
//! A film resists the relative velocity u of a pair in one mode with the force c u, and c diverges
//! as the gap closes. Its impulses are those of the implicit Euler step for all films together,
//! λ = −c (Δt/2) u(λ), on the velocities in the middle of a step and on those at its end: for any step, they are
//! equal and opposite, only dissipate energy, and let a load W close a gap at the velocity W/c. The part of c that
//! corrects the delay of loads (see [`law::LoadDelay`]) acts on u less its mean over the last steps, and may supply
//! energy over that time.

use super::{
    Body,
    body::{self, State},
    contact_list::ContactList,
    deforming::StepParams,
};
use crate::rock::{contact::ThinGap, integrate, law};
use glam::DVec3;

/// Residual, as a share of the first one, at which the iteration ends: far below the velocity to which a film
/// with a thousandth of the step as its time constant slows a pair.
const RESIDUAL_TOLERANCE: f64 = 1e-13;
/// Largest number of iterations per film; without rounding one per film suffices.
const ITERATIONS_PER_FILM: usize = 3;

/// Index that marks a block without films.
const NO_BODY: u32 = u32::MAX;

/// One mode of motion, closing or tilting, that a gap resists.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Film {
    pub blocks: [u32; 2],
    /// Direction in which the second block moves away from the first; zero for a tilt.
    pub normal: DVec3,
    /// Lever arm of the spin of each block: r × n, m, or the axis of a tilt.
    pub arms: [DVec3; 2],
    /// Resistance c, N s/m, or N m s for a tilt.
    pub resistance: f64,
    /// The part of it that acts on changes of the velocity only.
    pub delayed: f64,
}

impl Film {
    /// The films in a thin gap between two blocks with the centroids `centres` (m).
    pub fn of(
        thin_gap: &ThinGap,
        law: &law::Film,
        blocks: [u32; 2],
        centres: [DVec3; 2],
    ) -> impl Iterator<Item = Self> {
        let slips = |block: u32| law.slip.binary_search(&(block as usize)).is_ok();
        let slips = blocks.map(slips);
        // A gap with slip on one side is half of a symmetric gap of twice the width.
        let share = if slips[0] == slips[1] { 1.0 } else { 0.25 };
        let normal = thin_gap.normal;
        let delay = law.delay.map(|delay| delay.resistance(thin_gap));
        let (delayed, delayed_tilts) = delay.unwrap_or_default();
        let pushed = Self {
            blocks,
            normal,
            arms: centres.map(|centre| (thin_gap.point - centre).cross(normal)),
            resistance: share * law.resistance(thin_gap) + delayed,
            delayed,
        };
        let tilts = law.tilting(thin_gap);
        let tilted = (0..2).map(move |k| Self {
            blocks,
            normal: DVec3::ZERO,
            arms: [thin_gap.axis(k); 2],
            resistance: share * tilts[k] + delayed_tilts[k],
            delayed: delayed_tilts[k],
        });
        let all = std::iter::once(pushed).chain(tilted.collect::<Vec<_>>());
        all.filter(|film| film.resistance > 0.0)
    }

    /// Velocity, or rate of tilt, at which the gap opens, from the velocities and spins of the two blocks.
    fn opening(&self, [[v, spin], [other_v, other_spin]]: [[DVec3; 2]; 2]) -> f64 {
        self.normal.dot(other_v - v) + self.arms[1].dot(other_spin) - self.arms[0].dot(spin)
    }
}

/// Impulse of films on a block in half a step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FilmImpulse {
    /// Change of velocity, m/s.
    pub velocity: DVec3,
    /// Change of angular momentum about the centroid, kg m²/s.
    pub momentum: DVec3,
    /// Impulse on the block, whether it can move or not, N s.
    pub impulse: DVec3,
}

/// Motion of a block at a film, and its response to impulses.
#[derive(Clone, Copy, Debug, Default)]
struct FilmBody {
    block: usize,
    velocity: DVec3,
    spin: DVec3,
    /// Mean velocity and spin over the last steps.
    mean: [DVec3; 2],
    /// Inverse mass, 1/kg; 0 for a block that impulses do not move.
    inverse_mass: f64,
    /// Change of velocity and spin by the search direction of the impulses.
    direction_response: [DVec3; 2],
    push: FilmImpulse,
}

/// The row of one film in the system (1/κ + J M⁻¹ Jᵀ) λ = −(u − s ū), κ = c Δt/2, s being the delayed share of c and ū
/// the mean velocity, solved by conjugate gradients (Hestenes & Stiefel 1952).
#[derive(Clone, Copy, Debug)]
struct Row {
    film: Film,
    /// Indices of the two blocks among the film bodies.
    ends: [usize; 2],
    /// Relative velocity at the start of the half step.
    before: f64,
    /// The part s ū of the relative velocity on which the resistance does not act.
    steady: f64,
    /// Change of the spin of each block by a unit impulse.
    spin_response: [DVec3; 2],
    /// Its diagonal element, without 1/κ.
    yielding: f64,
    impulse: f64,
    residual: f64,
    direction: f64,
    /// The matrix of the system times the direction.
    image: f64,
}

/// The films of a step, in memory that all steps reuse.
#[derive(Clone, Debug, Default)]
pub(super) struct Films {
    /// Index of each block among the film bodies, or [`NO_BODY`]; empty before the first film.
    body_of_block: Vec<u32>,
    film_bodies: Vec<FilmBody>,
    rows: Vec<Row>,
    /// Length of the step, s.
    dt: f64,
    /// All blocks with films, and the mean forces of the films on them over the second half of the last step, N.
    pub forces: Vec<(u32, DVec3)>,
}

impl Films {
    /// Finds the impulses of the films of `contacts` in the first half of a step; returns the energy that they dissipate, J.
    pub fn first_half(
        &mut self,
        bodies: &[Body],
        states: &[State],
        contacts: &ContactList,
        params: StepParams,
    ) -> f64 {
        self.dt = params.dt;
        self.begin(bodies, states, contacts);
        for film_body in self.film_bodies.iter_mut().filter(|m| m.inverse_mass > 0.0) {
            let (body, state) = (&bodies[film_body.block], &states[film_body.block]);
            let (velocity, momentum) = body::first_half(body, state, params);
            film_body.velocity = velocity;
            film_body.spin = integrate::spin(&body.inertia, state.rotation, momentum);
        }
        self.solve()
    }

    /// Stores the motion of the blocks before the second half of a step.
    pub fn before_second_half(
        &mut self,
        bodies: &[Body],
        states: &[State],
        contacts: &ContactList,
    ) {
        self.begin(bodies, states, contacts);
    }

    /// Adds the impulses of the second half of the step to `states`; returns the energy that they
    /// dissipate, J.
    pub fn second_half(&mut self, bodies: &[Body], states: &mut [State]) -> f64 {
        for film_body in &mut self.film_bodies {
            let state = &states[film_body.block];
            (film_body.velocity, film_body.spin) = (state.velocity, state.spin);
        }
        let taken = self.solve();
        for film_body in self.film_bodies.iter().filter(|m| m.inverse_mass > 0.0) {
            let (body, state) = (&bodies[film_body.block], &mut states[film_body.block]);
            state.velocity += film_body.push.velocity;
            state.momentum += film_body.push.momentum;
            state.spin = integrate::spin(&body.inertia, state.rotation, state.momentum);
        }
        let half = 0.5 * self.dt;
        self.forces.clear();
        let bodies = self.film_bodies.iter();
        self.forces
            .extend(bodies.map(|one| (one.block as u32, one.push.impulse / half)));
        taken
    }

    /// Impulse of films on a block in the last half step.
    pub fn push(&self, block: usize) -> FilmImpulse {
        match self.body_of_block.get(block) {
            Some(&index) if index != NO_BODY => self.film_bodies[index as usize].push,
            _ => FilmImpulse::default(),
        }
    }

    /// Sets up the films of a half step, and the present motion of their blocks.
    fn begin(&mut self, bodies: &[Body], states: &[State], contacts: &ContactList) {
        for film_body in self.film_bodies.drain(..) {
            self.body_of_block[film_body.block] = NO_BODY;
        }
        self.rows.clear();
        for film in contacts.films() {
            self.body_of_block.resize(bodies.len(), NO_BODY);
            let mut row = Row {
                film: *film,
                ends: film
                    .blocks
                    .map(|block| self.film_body(block as usize, bodies, states)),
                before: 0.0,
                steady: 0.0,
                spin_response: [DVec3::ZERO; 2],
                yielding: 0.0,
                impulse: 0.0,
                residual: 0.0,
                direction: 0.0,
                image: 0.0,
            };
            for (k, end) in row.ends.into_iter().enumerate() {
                let FilmBody {
                    block,
                    inverse_mass,
                    ..
                } = self.film_bodies[end];
                if inverse_mass > 0.0 {
                    let (body, state) = (&bodies[block], &states[block]);
                    row.spin_response[k] =
                        integrate::spin(&body.inertia, state.rotation, film.arms[k]);
                    row.yielding += inverse_mass * film.normal.length_squared()
                        + film.arms[k].dot(row.spin_response[k]);
                }
            }
            row.before = self.relative(&row);
            let means = row.ends.map(|end| self.film_bodies[end].mean);
            row.steady = film.delayed / film.resistance * film.opening(means);
            self.rows.push(row);
        }
    }

    fn film_body(&mut self, block: usize, bodies: &[Body], states: &[State]) -> usize {
        if self.body_of_block[block] == NO_BODY {
            self.body_of_block[block] = self.film_bodies.len() as u32;
            let (body, state) = (&bodies[block], &states[block]);
            let inverse_mass = if state.asleep {
                0.0
            } else {
                body.inverse_mass()
            };
            self.film_bodies.push(FilmBody {
                block,
                velocity: state.velocity,
                // In the middle of a step the spin of a free body does not match its angular momentum yet.
                spin: match inverse_mass > 0.0 {
                    true => integrate::spin(&body.inertia, state.rotation, state.momentum),
                    false => state.spin,
                },
                mean: state.mean,
                inverse_mass,
                ..FilmBody::default()
            });
        }
        self.body_of_block[block] as usize
    }

    /// Velocity, or rate of tilt, at which the gap of a film opens.
    fn relative(&self, row: &Row) -> f64 {
        let ends = row.ends.map(|end| &self.film_bodies[end]);
        row.film
            .opening(ends.map(|body| [body.velocity, body.spin]))
    }

    /// Solves for the impulses of half a step, and returns the energy that they dissipate, J.
    fn solve(&mut self) -> f64 {
        let half = 0.5 * self.dt;
        if self.rows.is_empty() || half == 0.0 {
            return 0.0;
        }
        // The diagonal is the preconditioner.
        let diagonal = |row: &Row| row.yielding + 1.0 / (row.film.resistance * half);
        let mut size = 0.0;
        for n in 0..self.rows.len() {
            let relative = self.relative(&self.rows[n]);
            let row = &mut self.rows[n];
            let residual = row.steady - relative;
            (row.residual, row.impulse) = (residual, 0.0);
            row.direction = residual / diagonal(row);
            size += residual * row.direction;
        }
        let enough = RESIDUAL_TOLERANCE * RESIDUAL_TOLERANCE * size;
        for _ in 0..ITERATIONS_PER_FILM * self.rows.len() {
            if size <= enough {
                break;
            }
            let step = size / self.images(half);
            let mut next = 0.0;
            for row in &mut self.rows {
                row.impulse += step * row.direction;
                row.residual -= step * row.image;
                next += row.residual * row.residual / diagonal(row);
            }
            let ratio = next / size;
            for row in &mut self.rows {
                row.direction = row.residual / diagonal(row) + ratio * row.direction;
            }
            size = next;
        }
        self.apply()
    }

    /// Multiplies the matrix of the system by the direction, and returns the scalar product of the result and the direction.
    fn images(&mut self, half: f64) -> f64 {
        for film_body in &mut self.film_bodies {
            film_body.direction_response = [DVec3::ZERO; 2];
        }
        for row in &self.rows {
            for (k, sign) in [(0, -1.0), (1, 1.0)] {
                let film_body = &mut self.film_bodies[row.ends[k]];
                film_body.direction_response[0] +=
                    sign * row.direction * film_body.inverse_mass * row.film.normal;
                film_body.direction_response[1] += sign * row.direction * row.spin_response[k];
            }
        }
        let mut product = 0.0;
        for row in &mut self.rows {
            let [a, b] = row.ends.map(|end| self.film_bodies[end].direction_response);
            let Film {
                normal,
                arms,
                resistance,
                ..
            } = row.film;
            row.image = normal.dot(b[0] - a[0]) + arms[1].dot(b[1]) - arms[0].dot(a[1])
                + row.direction / (resistance * half);
            product += row.image * row.direction;
        }
        product
    }

    /// Applies the impulses to the blocks, and returns the energy that they dissipate, J: the work on the mean of the
    /// velocities at the start and at the end of the half step.
    fn apply(&mut self) -> f64 {
        for row in &self.rows {
            for (k, sign) in [(0, -1.0), (1, 1.0)] {
                let film_body = &mut self.film_bodies[row.ends[k]];
                let impulse = sign * row.impulse;
                film_body.push.impulse += impulse * row.film.normal;
                if film_body.inverse_mass > 0.0 {
                    film_body.push.velocity += impulse * film_body.inverse_mass * row.film.normal;
                    film_body.push.momentum += impulse * row.film.arms[k];
                    film_body.spin += impulse * row.spin_response[k];
                }
            }
        }
        for film_body in &mut self.film_bodies {
            film_body.velocity += film_body.push.velocity;
        }
        let taken = |row: &Row| -0.5 * row.impulse * (row.before + self.relative(row));
        self.rows.iter().map(taken).sum()
    }
}
