//! Films of fluid between blocks that nearly touch: they resist the closing, opening and tilting of the gap.
//!
//! A film takes from the relative motion u of a pair along one direction at the rate c u, with c that grows beyond
//! all bounds as the gap closes. Its impulses are those of the implicit Euler step for all films together,
//! λ = −c (Δt/2) u(λ), on the velocities in the middle of a step and on those at its end: whatever the step, they are
//! equal and opposite, take energy only, and let a load W press a gap together at W/c.

use super::{
    Body,
    body::{self, State},
    deforming::Under,
    touch::NONE,
    touches::Touches,
};
use crate::rock::{contact::Squeeze, integrate, law};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Residual, as a share of the first one, at which the impulses are known: far below the velocity to which a film
/// of a thousandth of the step's own time slows a pair.
const SETTLED: f64 = 1e-13;
/// Iterations at most for each film; as many as there are films would do without rounding.
const MOST: usize = 3;

/// One way in which one gap resists.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Film {
    pub blocks: [u32; 2],
    /// Along which the second block moves away from the first; zero for a tilt.
    pub normal: DVec3,
    /// What the spin of each block adds to that: r × n, m, or the axis of a tilt.
    pub arms: [DVec3; 2],
    /// N s/m, or N m s.
    pub resistance: f64,
}

impl Film {
    /// The films in a thin gap between two blocks with these centroids (m).
    pub fn of(
        squeeze: &Squeeze,
        law: &law::Film,
        blocks: [u32; 2],
        centres: [DVec3; 2],
    ) -> impl Iterator<Item = Self> {
        let slips = |block: u32| law.slip.binary_search(&(block as usize)).is_ok();
        let slips = blocks.map(slips);
        // Where fluid slips along one side of a gap, twice as wide a one would be symmetric about it.
        let share = if slips[0] == slips[1] { 1.0 } else { 0.25 };
        let normal = squeeze.normal;
        let pushed = Self {
            blocks,
            normal,
            arms: centres.map(|centre| (squeeze.point - centre).cross(normal)),
            resistance: share * law.resistance(squeeze),
        };
        let tilts = law.tilting(squeeze);
        let tilted = (0..2).map(move |k| Self {
            blocks,
            normal: DVec3::ZERO,
            arms: [squeeze.axis(k); 2],
            resistance: share * tilts[k],
        });
        let all = std::iter::once(pushed).chain(tilted.collect::<Vec<_>>());
        all.filter(|film| film.resistance > 0.0)
    }
}

/// What films do to a block in half a step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Push {
    /// m/s.
    pub velocity: DVec3,
    /// Of angular momentum about the centroid, kg m²/s.
    pub momentum: DVec3,
    /// Impulse on it, whether it moves or not, N s.
    pub impulse: DVec3,
}

/// How a block moves, and how it gives way to films.
#[derive(Clone, Copy, Debug, Default)]
struct Mover {
    block: usize,
    velocity: DVec3,
    spin: DVec3,
    /// 1/kg; 0 of what does not give way.
    inverse_mass: f64,
    /// What a direction of the impulses does to its velocity and spin.
    tried: [DVec3; 2],
    push: Push,
}

/// A film of the system (1/κ + J M⁻¹ Jᵀ) λ = −u, κ = c Δt/2, solved by conjugate gradients, whose every step takes
/// energy (Hestenes & Stiefel 1952).
#[derive(Clone, Copy, Debug)]
struct Row {
    film: Film,
    /// Blocks among the movers.
    ends: [usize; 2],
    /// Relative velocity at the start of the half step.
    before: f64,
    /// What a unit of impulse does to the spin of each block.
    turns: [DVec3; 2],
    /// Its place on the diagonal, without 1/κ.
    yielding: f64,
    impulse: f64,
    residual: f64,
    direction: f64,
    /// The system times the direction.
    image: f64,
}

/// The films of a step, its memory used again and again.
#[derive(Clone, Debug, Default)]
pub(super) struct Films {
    /// Which mover a block is, or [`NONE`]; empty before the first film.
    slots: Vec<u32>,
    movers: Vec<Mover>,
    rows: Vec<Row>,
    /// Length of the step, s.
    dt: f64,
}

impl Films {
    /// Finds the pushes in the first half of a step, of the films of `touches`; returns the energy that they take, J.
    pub fn first_half(
        &mut self,
        (bodies, states): (&[Body], &[State]),
        touches: &Touches,
        under: Under,
    ) -> f64 {
        self.dt = under.dt;
        self.begin((bodies, states), touches);
        for mover in self.movers.iter_mut().filter(|m| m.inverse_mass > 0.0) {
            let (body, state) = (&bodies[mover.block], &states[mover.block]);
            let (velocity, momentum) = body::first_half(body, state, under);
            mover.velocity = velocity;
            mover.spin = integrate::spin(&body.inertia, state.rotation, momentum);
        }
        self.solve()
    }

    /// Remembers how blocks move before the second half of a step.
    pub fn before_second_half(&mut self, (bodies, states): (&[Body], &[State]), touches: &Touches) {
        self.begin((bodies, states), touches);
    }

    /// Adds the pushes in the second half of the step to `states` as it left them; returns the energy that they
    /// take, J.
    pub fn second_half(&mut self, bodies: &[Body], states: &mut [State]) -> f64 {
        for mover in &mut self.movers {
            let state = &states[mover.block];
            (mover.velocity, mover.spin) = (state.velocity, state.spin);
        }
        let taken = self.solve();
        for mover in self.movers.iter().filter(|m| m.inverse_mass > 0.0) {
            let (body, state) = (&bodies[mover.block], &mut states[mover.block]);
            state.velocity += mover.push.velocity;
            state.momentum += mover.push.momentum;
            state.spin = integrate::spin(&body.inertia, state.rotation, state.momentum);
        }
        taken
    }

    /// What films did to a block in the last half step.
    pub fn push(&self, block: usize) -> Push {
        match self.slots.get(block) {
            Some(&slot) if slot != NONE => self.movers[slot as usize].push,
            _ => Push::default(),
        }
    }

    /// What they did to all blocks that have films: blocks, and forces, N.
    pub fn forces(&self) -> impl Iterator<Item = (usize, DVec3)> + '_ {
        let half = 0.5 * self.dt;
        self.movers
            .iter()
            .map(move |mover| (mover.block, mover.push.impulse / half))
    }

    /// The films of a half step and the blocks that they are beside, as these move now.
    fn begin(&mut self, (bodies, states): (&[Body], &[State]), touches: &Touches) {
        for mover in self.movers.drain(..) {
            self.slots[mover.block] = NONE;
        }
        self.rows.clear();
        for film in touches.films() {
            self.slots.resize(bodies.len(), NONE);
            let mut row = Row {
                film: *film,
                ends: film
                    .blocks
                    .map(|block| self.mover(block as usize, bodies, states)),
                before: 0.0,
                turns: [DVec3::ZERO; 2],
                yielding: 0.0,
                impulse: 0.0,
                residual: 0.0,
                direction: 0.0,
                image: 0.0,
            };
            for (k, end) in row.ends.into_iter().enumerate() {
                let Mover {
                    block,
                    inverse_mass,
                    ..
                } = self.movers[end];
                if inverse_mass > 0.0 {
                    let (body, state) = (&bodies[block], &states[block]);
                    row.turns[k] = integrate::spin(&body.inertia, state.rotation, film.arms[k]);
                    row.yielding += inverse_mass * film.normal.length_squared()
                        + film.arms[k].dot(row.turns[k]);
                }
            }
            row.before = self.relative(&row);
            self.rows.push(row);
        }
    }

    fn mover(&mut self, block: usize, bodies: &[Body], states: &[State]) -> usize {
        if self.slots[block] == NONE {
            self.slots[block] = self.movers.len() as u32;
            let (body, state) = (&bodies[block], &states[block]);
            let inverse_mass = if state.asleep {
                0.0
            } else {
                body.inverse_mass()
            };
            self.movers.push(Mover {
                block,
                velocity: state.velocity,
                // In the middle of a step the spin of a free body is not that of its momentum yet.
                spin: match inverse_mass > 0.0 {
                    true => integrate::spin(&body.inertia, state.rotation, state.momentum),
                    false => state.spin,
                },
                inverse_mass,
                ..Mover::default()
            });
        }
        self.slots[block] as usize
    }

    /// Velocity, or rate of tilt, at which the gap of a film opens.
    fn relative(&self, row: &Row) -> f64 {
        let [a, b] = row.ends.map(|end| &self.movers[end]);
        let Film { normal, arms, .. } = row.film;
        normal.dot(b.velocity - a.velocity) + arms[1].dot(b.spin) - arms[0].dot(a.spin)
    }

    /// Solves for the impulses of half a step, and returns the energy that they take, J.
    fn solve(&mut self) -> f64 {
        let half = 0.5 * self.dt;
        if self.rows.is_empty() || half == 0.0 {
            return 0.0;
        }
        // The diagonal is the preconditioner.
        let diagonal = |row: &Row| row.yielding + 1.0 / (row.film.resistance * half);
        let mut size = 0.0;
        for n in 0..self.rows.len() {
            let residual = -self.relative(&self.rows[n]);
            let row = &mut self.rows[n];
            (row.residual, row.impulse) = (residual, 0.0);
            row.direction = residual / diagonal(row);
            size += residual * row.direction;
        }
        let enough = SETTLED * SETTLED * size;
        for _ in 0..MOST * self.rows.len() {
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
        self.act()
    }

    /// Multiplies the system with the direction, and returns the product of both.
    fn images(&mut self, half: f64) -> f64 {
        for mover in &mut self.movers {
            mover.tried = [DVec3::ZERO; 2];
        }
        for row in &self.rows {
            for (k, sign) in [(0, -1.0), (1, 1.0)] {
                let mover = &mut self.movers[row.ends[k]];
                mover.tried[0] += sign * row.direction * mover.inverse_mass * row.film.normal;
                mover.tried[1] += sign * row.direction * row.turns[k];
            }
        }
        let mut product = 0.0;
        for row in &mut self.rows {
            let [a, b] = row.ends.map(|end| self.movers[end].tried);
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

    /// Makes pushes of the impulses, and returns the energy that they take, J: they meet the mean of the velocities
    /// at the start and at the end of the half step.
    fn act(&mut self) -> f64 {
        for row in &self.rows {
            for (k, sign) in [(0, -1.0), (1, 1.0)] {
                let mover = &mut self.movers[row.ends[k]];
                let impulse = sign * row.impulse;
                mover.push.impulse += impulse * row.film.normal;
                if mover.inverse_mass > 0.0 {
                    mover.push.velocity += impulse * mover.inverse_mass * row.film.normal;
                    mover.push.momentum += impulse * row.film.arms[k];
                    mover.spin += impulse * row.turns[k];
                }
            }
        }
        for mover in &mut self.movers {
            mover.velocity += mover.push.velocity;
        }
        let taken = |row: &Row| -0.5 * row.impulse * (row.before + self.relative(row));
        self.rows.iter().map(taken).sum()
    }
}
