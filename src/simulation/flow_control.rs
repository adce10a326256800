//! Proportional-integral control of the body force that maintains the bulk velocity of a periodic flow. With the velocity
//! error e, M steps from one measurement to the next and T = 10 M, I += e M r / T and F = I + e / T. Without friction
//! r = 1 / (4 T) damps critically. If friction alone slows the flow down at a greater rate, r is that rate, since the
//! integral part then has to find the force: the rate follows from the force and the change of velocity between two measurements.

use super::lattice_fluid::LatticeFluid;
use crate::{
    Result,
    lattice::Sums,
    scene::{Boundary, Face, Scene},
    units::{SOUND_SPEED_SQUARED, Units},
};

/// Steps from one measurement to the next.
const STEPS: u64 = 50;
/// Steps in which the proportional part alone removes an error.
const TIME: f64 = 10.0 * STEPS as f64;
/// Bounds on the integral part, of which the greater holds: an error that no force corrects must not accumulate without limit.
/// Relative to the friction of a smooth wall.
const LARGEST: f64 = 100.0;
/// Relative difference of density over the domain, if obstacles bear all of the force.
const LARGEST_DROP: f64 = 0.1;
/// Part of the prescribed velocity from which the rate of friction is known.
const LEAST_VELOCITY: f64 = 1e-3;

/// Controller of the bulk velocity of a fluid, in lattice units.
#[derive(Debug)]
pub(super) struct FlowControl {
    axis: usize,
    /// Prescribed bulk velocity.
    target: f64,
    /// Constant body force per mass of the scene.
    base: [f64; 3],
    /// Smallest r, per step.
    rate: f64,
    /// Estimated friction of smooth walls: the force at the start.
    usual: f64,
    /// Bound on the integral part.
    largest: f64,
    state: FlowControlState,
}

/// State of the controller between two steps, lattice units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct FlowControlState {
    /// Integral part I.
    pub integral: f64,
    /// Force per mass F.
    pub force: f64,
    /// Bulk velocity at the last measurement; none before the first.
    pub velocity: Option<f64>,
}

impl FlowControlState {
    fn start(force: f64) -> Self {
        Self {
            integral: force,
            force,
            velocity: None,
        }
    }
}

impl FlowControl {
    /// The controller of a scene; `None` without a prescribed bulk velocity.
    pub fn new(scene: &Scene, units: &Units) -> Option<Self> {
        let (axis, velocity) = scene.fluid.kept_velocity()?;
        let target = units.velocity_to_lattice(velocity);
        let constant = scene.fluid.acceleration.each_ref().map(|a| a.constant());
        let base = constant.map(|a| units.acceleration_to_lattice(a.unwrap_or_default()));
        // Half the distance of the closest pair of walls; without walls, half the domain along the flow.
        let cells = scene.cells().map(f64::from);
        let between = (0..3).filter(|&other| other != axis).filter(|&other| {
            let faces = &scene.boundaries;
            let mut pair = Face::ALL[2 * other..2 * other + 2].iter();
            pair.any(|face| matches!(faces.face(*face), Boundary::Wall { .. }))
        });
        let across = between.map(|other| cells[other]).reduce(f64::min);
        let half = 0.5 * across.unwrap_or(cells[axis]);
        let viscosity = units.viscosity_to_lattice(scene.fluid.viscosity);
        // Turbulent friction, at a friction velocity of a twentieth of the bulk velocity, plus laminar friction.
        let usual =
            target * target.abs() / (400.0 * half) + 3.0 * viscosity * target / (half * half);
        Some(Self {
            axis,
            target,
            base,
            rate: (usual / target).max(0.25 / TIME),
            usual,
            largest: (LARGEST * usual.abs()).max(LARGEST_DROP * SOUND_SPEED_SQUARED / cells[axis]),
            state: FlowControlState::start(usual),
        })
    }

    /// The mean velocity along the axis, cells per step.
    pub fn bulk_velocity(&self, sums: &Sums) -> f64 {
        sums.momentum[self.axis] / (sums.cells + sums.excess).max(1.0)
    }

    /// The force per mass that maintains the bulk velocity, lattice units.
    pub fn acceleration(&self) -> f64 {
        self.state.force
    }

    pub fn state(&self) -> FlowControlState {
        self.state
    }

    /// Updates the force from a measured bulk velocity.
    fn follow(&mut self, velocity: f64) {
        let error = self.target - velocity;
        let rate = self.friction_rate(velocity).max(self.rate);
        let integral = self.state.integral + error * STEPS as f64 * rate / TIME;
        let integral = integral.clamp(-self.largest, self.largest);
        self.state = FlowControlState {
            integral,
            force: integral + error / TIME,
            velocity: Some(velocity),
        };
    }

    /// The rate per step at which friction slowed the flow down since the last measurement, at most that of one interval.
    fn friction_rate(&self, velocity: f64) -> f64 {
        let before = self.state.velocity;
        let Some(before) = before.filter(|_| velocity.abs() > LEAST_VELOCITY * self.target.abs())
        else {
            return 0.0;
        };
        let change = (velocity - before) / STEPS as f64;
        let friction = self.force()[self.axis] - change;
        (friction / velocity).min(1.0 / STEPS as f64)
    }

    /// The force on all cells.
    fn force(&self) -> [f64; 3] {
        let mut force = self.base;
        force[self.axis] += self.state.force;
        force
    }
}

impl LatticeFluid {
    /// Whether the bulk velocity is measured after the present step.
    pub(super) fn control_due(&self) -> bool {
        self.flow_control.is_some() && self.lattice.step().is_multiple_of(STEPS)
    }

    /// Measures the bulk velocity, if due, and applies the updated force.
    pub(super) async fn control_flow(&mut self) -> Result<()> {
        if !self.control_due() {
            return Ok(());
        }
        let (device, queue) = (&self.device, &self.queue);
        let sums = self.observer.sums(device, queue, &mut self.lattice).await?;
        if let Some(control) = &mut self.flow_control {
            let velocity = control.bulk_velocity(&sums);
            // The guard detects a flow that has left the range of the method.
            if velocity.is_finite() {
                control.follow(velocity);
            }
        }
        self.apply_flow_control()
    }

    /// Continues from a state; without one the control starts anew.
    pub(super) fn restore_flow_control(&mut self, state: Option<FlowControlState>) -> Result<()> {
        if let Some(control) = &mut self.flow_control {
            control.state = state.unwrap_or(FlowControlState::start(control.usual));
        }
        self.apply_flow_control()
    }

    /// Applies the present force to the fluid, and passes it to the coupling with the blocks.
    pub(super) fn apply_flow_control(&mut self) -> Result<()> {
        let Some(control) = &self.flow_control else {
            return Ok(());
        };
        let force = control.force();
        self.lattice.set_force(&self.queue, force)?;
        if let Some(coupling) = &mut self.coupling {
            let per_mass = self.units.acceleration_to_lattice(1.0);
            coupling.set_acceleration(force.map(|force| force / per_mass));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn control() -> FlowControl {
        FlowControl {
            axis: 0,
            target: 0.05,
            base: [0.0; 3],
            rate: 0.25 / TIME,
            usual: 1e-6,
            largest: 5e-4,
            state: FlowControlState::start(1e-6),
        }
    }

    /// The bulk velocity after 6000 steps in units of the prescribed one, if friction slows the flow down at the given rate and at
    /// a rate proportional to the velocity.
    fn after(linear: f64, quadratic: f64) -> f64 {
        let mut control = control();
        let mut velocity: f64 = 0.0;
        for step in 1..=6000 {
            let friction = (linear + quadratic * velocity.abs()) * velocity;
            velocity += control.force()[0] - friction;
            if step % STEPS == 0 {
                control.follow(velocity);
            }
        }
        velocity / control.target
    }

    #[test]
    fn the_force_finds_any_friction() {
        for (linear, quadratic) in [
            (2e-3, 0.0),
            (5e-3, 0.0),
            (9e-3, 0.0),
            (0.0, 0.05),
            (0.0, 0.15),
        ] {
            let found = after(linear, quadratic);
            assert!((found - 1.0).abs() < 0.02, "{linear} {quadratic}: {found}");
        }
    }

    #[test]
    fn a_flow_that_cannot_move_is_pushed_with_the_largest_force() {
        let mut control = control();
        for _ in 0..100_000 {
            control.follow(0.0);
        }
        assert_eq!(control.state.integral, control.largest);
    }
}
