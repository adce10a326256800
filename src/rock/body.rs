//! One block: its constants ([`Body`]), its state ([`State`]), the forces applied to it, and its motion over a step.

use super::{
    Block, Motion, PointLoad, Setup, Sleep,
    contact_list::ContactSum,
    deforming::{DeformingBlocks, RIGID, StepParams},
    films::FilmImpulse,
};
use crate::{
    formula::Formula,
    geometry::{Pose, Shape, outer},
    rock::integrate::{self, Principal, Wrench},
};
use glam::{DMat3, DQuat, DVec3};
use std::{ops::Range, sync::Arc};

/// Constants of a block.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub name: String,
    pub shape: Arc<Shape>,
    pub material: u32,
    /// Index among the deformable blocks, or [`RIGID`].
    pub deforming: u32,
    pub drive: Drive,
    /// Unit vector of the guide along which the block moves without rotation; `None` without a guide.
    pub guide: Option<Box<DVec3>>,
    /// kg.
    pub mass: f64,
    /// kg m².
    pub inertia: Principal,
    /// Radius of the bounding ball about the centroid, m.
    pub radius: f64,
    /// Indices of its parts among all parts.
    pub parts: Range<usize>,
}

/// Kind of motion. Formulas are rare and stored elsewhere to keep a body small, because all bodies are read in each step.
#[derive(Clone, Debug)]
pub(super) enum Drive {
    /// Free: moved by contacts and loads, and possibly by forces of its own.
    Forces(Option<Box<AppliedForces>>),
    Nothing,
    /// Driven: prescribed velocity and spin.
    Formulas(Box<[[Formula; 3]; 2]>),
}

impl Drive {
    pub fn of(block: &Block) -> Self {
        match &block.motion {
            Motion::Free => Self::Forces(AppliedForces::of(block)),
            Motion::Fixed => Self::Nothing,
            Motion::Driven { velocity, spin } => {
                Self::Formulas(Box::new([velocity.clone(), spin.clone()]))
            }
        }
    }
}

impl Body {
    pub fn is_free(&self) -> bool {
        matches!(self.drive, Drive::Forces(_))
    }

    pub fn is_fixed(&self) -> bool {
        matches!(self.drive, Drive::Nothing)
    }

    /// Velocity and spin of a driven block at the time `t`; zero for others.
    pub fn driven_at(&self, t: f64) -> [DVec3; 2] {
        let Drive::Formulas(formulas) = &self.drive else {
            return [DVec3::ZERO; 2];
        };
        formulas.each_ref().map(|v| formula_values(v, t))
    }

    /// The first formula of a drive, a point load or an acceleration whose value is not finite at the time `t` (s), if any.
    pub fn undefined_at(&self, t: f64) -> Option<&str> {
        let formulas: Vec<&[Formula; 3]> = match &self.drive {
            Drive::Formulas(formulas) => formulas.iter().collect(),
            Drive::Forces(Some(applied)) => {
                let loads = applied.point_loads.iter().map(|load| &load.force);
                loads.chain(&applied.acceleration).collect()
            }
            Drive::Forces(None) | Drive::Nothing => Vec::new(),
        };
        let mut all = formulas.into_iter().flatten();
        let lost = all.find(|formula| !formula.eval_at([0.0; 3], t).is_finite());
        lost.map(Formula::text)
    }

    /// Point loads and acceleration of this block, if any.
    pub fn applied_forces(&self) -> Option<&AppliedForces> {
        match &self.drive {
            Drive::Forces(applied_forces) => applied_forces.as_deref(),
            _ => None,
        }
    }

    /// Whether the block may sleep. Deformable blocks keep oscillating, and formulas of time cannot wake a block.
    pub fn may_sleep(&self) -> bool {
        matches!(self.drive, Drive::Forces(None)) && self.deforming == RIGID
    }

    /// Force over mass including gravity, m/s², and torque, N m, on a free rigid block at the time `t` (s).
    fn pulls(&self, state: &State, gravity: DVec3, t: f64) -> [DVec3; 2] {
        let mut force = state.force + state.load;
        let mut torque = state.torque + state.load_torque;
        if let Some(applied_forces) = self.applied_forces() {
            let more = applied_forces.wrench(DMat3::from_quat(state.rotation), self.mass, t);
            force += more.force;
            torque += integrate::axial(more.moment);
        }
        let rate = force / self.mass + gravity;
        match self.guide.as_deref() {
            Some(axis) => [axis.dot(rate) * *axis, DVec3::ZERO],
            None => [rate, torque],
        }
    }

    /// Replaces the inertia by that `of` the shape at a density of one, m⁵, and sets the angular momentum of `state`.
    pub fn hold(&mut self, of: Principal, state: &mut State) {
        self.inertia = of.scaled(self.mass / self.shape.volume());
        state.momentum = self.momentum_of(state);
    }

    /// Angular momentum of a block with the spin of `state`, world, kg m²/s.
    fn momentum_of(&self, state: &State) -> DVec3 {
        let frame = state.rotation * self.inertia.axes;
        frame * ((frame.conjugate() * state.spin) * self.inertia.moments)
    }

    /// Inverse mass, 1/kg; 0 if forces do not move the block.
    pub fn inverse_mass(&self) -> f64 {
        if self.is_free() { 1.0 / self.mass } else { 0.0 }
    }
}

/// State of a block between two steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct State {
    /// m.
    pub centre: DVec3,
    pub rotation: DQuat,
    /// m/s.
    pub velocity: DVec3,
    /// Angular momentum, world, kg m²/s.
    pub momentum: DVec3,
    /// Spin, world, rad/s.
    pub spin: DVec3,
    /// Net force of the contacts, N.
    pub force: DVec3,
    /// Net torque of the contacts, N m.
    pub torque: DVec3,
    /// External force, N.
    pub load: DVec3,
    /// External torque, N m.
    pub load_torque: DVec3,
    /// Mean velocity and spin over the memory of [`LoadDelay`](super::law::LoadDelay); unused without it.
    pub mean: [DVec3; 2],
    /// Time for which the block has been slow, s.
    pub slow: f64,
    pub asleep: bool,
    /// Force and torque at the time the block fell asleep, loads included.
    pub slept: [DVec3; 2],
}

impl State {
    /// Sets the net force and torque of the contacts.
    pub fn set_contact_forces(&mut self, sum: &ContactSum) {
        (self.force, self.torque) = (sum.force, sum.torque);
    }

    pub fn pose(&self) -> Pose {
        Pose::rigid(self.centre, self.rotation, self.velocity, self.spin)
    }

    /// Whether the state is finite, squares included, as distances and energies need them.
    pub fn is_finite(&self) -> bool {
        let squares = [self.centre, self.velocity, self.momentum, self.spin];
        self.rotation.is_finite() && squares.iter().all(|v| v.length_squared().is_finite())
    }

    /// ½mv² + ½ω·L, J.
    pub fn kinetic(&self, mass: f64) -> f64 {
        0.5 * (mass * self.velocity.length_squared() + self.spin.dot(self.momentum))
    }

    /// Speed of its fastest point, m/s.
    pub fn fastest(&self, radius: f64) -> f64 {
        self.velocity.length() + self.spin.length() * radius
    }

    fn pulls(&self) -> [DVec3; 2] {
        [self.force + self.load, self.torque + self.load_torque]
    }

    /// Wakes a sleeping block whose forces have changed. It has been at rest so far, so that the rest of the
    /// step moves it like a block that was awake.
    pub fn wake(&mut self, body: &Body, sleep: &Sleep, gravity: DVec3) {
        let [force, torque] = self.pulls();
        let [slept, slept_torque] = self.slept;
        let weight = body.mass * gravity.length();
        let scale = if weight > 0.0 { weight } else { slept.length() };
        let changed = (force - slept).length() > sleep.change * scale
            || (torque - slept_torque).length() > sleep.change * scale * body.radius;
        if self.asleep && changed {
            self.asleep = false;
            self.slow = 0.0;
        }
    }

    /// Updates the means over the time `memory` (s) at the end of a step of `dt` (s).
    pub fn update_mean(&mut self, memory: f64, dt: f64) {
        let share = dt / (memory + dt);
        for (mean, now) in self.mean.iter_mut().zip([self.velocity, self.spin]) {
            *mean += share * (now - *mean);
        }
    }

    /// Puts the block to sleep at the end of a step of `dt` (s), if it has been slow for long enough. Returns the kinetic energy
    /// that this removes, J.
    pub fn update_sleep(&mut self, body: &Body, sleep: &Sleep, dt: f64) -> f64 {
        if self.asleep {
            return 0.0;
        }
        if self.fastest(body.radius) >= sleep.speed {
            self.slow = 0.0;
            return 0.0;
        }
        self.slow += dt;
        if self.slow < sleep.after {
            return 0.0;
        }
        let removed = self.kinetic(body.mass);
        self.asleep = true;
        self.slept = self.pulls();
        self.velocity = DVec3::ZERO;
        self.momentum = DVec3::ZERO;
        self.spin = DVec3::ZERO;
        removed
    }
}

/// Motion of a block within a step, and the constants that its contacts need. They are stored together, because each contact
/// reads two blocks at arbitrary places of the lists.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct MidStep {
    /// At the end of the step, m.
    pub centre: DVec3,
    /// At the end of the step.
    pub rotation: DQuat,
    /// Mean velocity over the step, m/s.
    pub velocity: DVec3,
    /// Mean spin over the step, rad/s.
    pub spin: DVec3,
    /// Velocity expected at the end, m/s.
    pub end_velocity: DVec3,
    /// Spin expected at the end, rad/s.
    pub end_spin: DVec3,
    /// Inverse mass, 1/kg; 0 if forces do not move the block.
    pub inverse_mass: f64,
    pub material: u32,
    /// Whether it is fixed or sleeps.
    pub rests: bool,
}

impl MidStep {
    /// The motion of a block at rest in `state`.
    pub fn at_rest(body: &Body, state: &State) -> Self {
        Self {
            centre: state.centre,
            rotation: state.rotation,
            inverse_mass: body.inverse_mass(),
            material: body.material,
            rests: body.is_fixed() || state.asleep,
            ..Self::default()
        }
    }

    /// The motion of a block before its first step.
    pub fn at_start(body: &Body, state: &State) -> Self {
        Self {
            end_velocity: state.velocity,
            end_spin: state.spin,
            ..Self::at_rest(body, state)
        }
    }
}

/// Velocity and angular momentum of a free rigid block in the middle of a step.
pub(super) fn first_half(body: &Body, state: &State, params: StepParams) -> (DVec3, DVec3) {
    let StepParams {
        gravity,
        damping,
        time,
        dt,
        ..
    } = params;
    let [rate, torque] = body.pulls(state, gravity, time);
    (
        integrate::first_kick(state.velocity, rate, damping, dt),
        integrate::first_kick(state.momentum, torque, damping, dt),
    )
}

/// Kick and drift of one block over `dt` from `time`. Sleeping and fixed blocks do not move; [`DeformingBlocks`] moves
/// deformable ones. `push`: impulse of films of fluid in the first half of the step.
pub(super) fn kick_drift(
    body: &Body,
    state: &mut State,
    push: FilmImpulse,
    params: StepParams,
) -> MidStep {
    let StepParams { time, dt, .. } = params;
    match &body.drive {
        Drive::Nothing => MidStep::at_rest(body, state),
        Drive::Forces(_) if state.asleep || body.deforming != RIGID => {
            MidStep::at_rest(body, state)
        }
        Drive::Forces(_) => {
            let (velocity, momentum) = first_half(body, state, params);
            let (velocity, momentum) = (velocity + push.velocity, momentum + push.momentum);
            // The dashpots need the velocity at the end of the step, which depends on the force there:
            // the last acceleration gives it to second order.
            let end_velocity = 2.0 * velocity - state.velocity;
            let end_momentum = 2.0 * momentum - state.momentum;
            state.centre += velocity * dt;
            state.rotation = integrate::turn(&body.inertia, state.rotation, momentum, dt);
            (state.velocity, state.momentum) = (velocity, momentum);
            MidStep {
                velocity,
                spin: integrate::spin(&body.inertia, state.rotation, momentum),
                end_velocity,
                end_spin: integrate::spin(&body.inertia, state.rotation, end_momentum),
                ..MidStep::at_rest(body, state)
            }
        }
        Drive::Formulas(_) => {
            let [mid_velocity, mid_spin] = body.driven_at(time + 0.5 * dt);
            state.centre += mid_velocity * dt;
            state.rotation = (DQuat::from_scaled_axis(mid_spin * dt) * state.rotation).normalize();
            [state.velocity, state.spin] = body.driven_at(time + dt);
            MidStep {
                velocity: mid_velocity,
                spin: mid_spin,
                end_velocity: state.velocity,
                end_spin: state.spin,
                ..MidStep::at_rest(body, state)
            }
        }
    }
}

/// The second kick of a step, with the forces at its end.
pub(super) fn second_kick(body: &Body, state: &mut State, params: StepParams) {
    if !body.is_free() || state.asleep || body.deforming != RIGID {
        return;
    }
    let StepParams {
        gravity,
        damping,
        time,
        dt,
        ..
    } = params;
    let [rate, torque] = body.pulls(state, gravity, time + dt);
    state.velocity = integrate::second_kick(state.velocity, rate, damping, dt);
    state.momentum = integrate::second_kick(state.momentum, torque, damping, dt);
    state.spin = integrate::spin(&body.inertia, state.rotation, state.momentum);
}

/// Creates the blocks of a checked setup.
pub(super) fn make(setup: &Setup) -> (Vec<Body>, Vec<State>, DeformingBlocks) {
    let mut bodies: Vec<Body> = Vec::with_capacity(setup.blocks.len());
    let mut states = Vec::with_capacity(setup.blocks.len());
    let mut deforming = DeformingBlocks::default();
    let mut first = 0;
    for (index, block) in setup.blocks.iter().enumerate() {
        let material = &setup.materials[block.material];
        let count = block.shape.parts().len();
        let body = Body {
            name: block.name.clone(),
            mass: material.density * block.shape.volume(),
            inertia: Principal::of(block.shape.inertia()).scaled(material.density),
            shape: block.shape.clone(),
            radius: block.shape.radius(),
            material: block.material as u32,
            deforming: deforming.add(index, block, material),
            drive: Drive::of(block),
            guide: None,
            parts: first..first + count,
        };
        first += count;
        states.push(start(&body, block));
        bodies.push(body);
    }
    for guide in &setup.guides {
        bodies[guide.block].guide = Some(Box::new(guide.axis.normalize()));
    }
    (bodies, states, deforming)
}

fn start(body: &Body, block: &Block) -> State {
    let mut state = State {
        centre: block.centre,
        rotation: block.rotation.normalize(),
        velocity: block.velocity,
        spin: block.spin,
        ..State::default()
    };
    match &body.drive {
        Drive::Forces(_) => state.momentum = body.momentum_of(&state),
        Drive::Nothing => (state.velocity, state.spin) = (DVec3::ZERO, DVec3::ZERO),
        Drive::Formulas(_) => [state.velocity, state.spin] = body.driven_at(0.0),
    }
    state.mean = [state.velocity, state.spin];
    state
}

/// Point loads and the acceleration of one block, in addition to gravity, contacts and external loads.
#[derive(Clone, Debug)]
pub(super) struct AppliedForces {
    point_loads: Vec<PointLoad>,
    acceleration: Option<[Formula; 3]>,
}

impl AppliedForces {
    /// The applied loads of a block, if there are any.
    pub fn of(block: &Block) -> Option<Box<Self>> {
        let some = !block.point_loads.is_empty() || block.acceleration.is_some();
        some.then(|| {
            Box::new(Self {
                point_loads: block.point_loads.clone(),
                acceleration: block.acceleration.clone(),
            })
        })
    }

    /// Force and moment about the centroid at the time `t` (s), for a block of the given `mass` (kg) and
    /// `deformation`.
    pub fn wrench(&self, deformation: DMat3, mass: f64, t: f64) -> Wrench {
        let mut wrench = Wrench {
            force: self
                .acceleration
                .as_ref()
                .map_or(DVec3::ZERO, |a| mass * formula_values(a, t)),
            moment: DMat3::ZERO,
        };
        for load in &self.point_loads {
            let force = formula_values(&load.force, t);
            wrench.force += force;
            wrench.moment += outer(force, deformation * load.point);
        }
        wrench
    }
}

/// Values of three formulas at the time `t` (s).
pub(crate) fn formula_values(formulas: &[Formula; 3], t: f64) -> DVec3 {
    DVec3::from_array(formulas.each_ref().map(|f| f.eval_at([0.0; 3], t)))
}
