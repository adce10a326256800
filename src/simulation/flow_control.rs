//! A body force that keeps the bulk velocity of a periodic flow, by an integral and a proportional part: with the error e of
//! the velocity, steps M from one measurement to the next and T = 10 M, I += e M r / T and F = I + e / T. Without friction
//! r = 1 / (4 T) damps critically; where friction alone slows the flow down at a greater rate, r is that rate, since the force
//! then has to be found by the integral part.

use super::lattice_fluid::LatticeFluid;
use crate::{
    Result,
    lattice::Sums,
    scene::{Boundary, Face, Scene},
    units::Units,
};

/// Steps from one measurement to the next.
const STEPS: u64 = 50;
/// Steps in which an error would be gone.
const TIME: f64 = 10.0 * STEPS as f64;
/// Largest integral part over what a smooth wall takes: an error that no force mends does not add up for ever.
const LARGEST: f64 = 100.0;

/// What keeps the bulk velocity of a fluid, in lattice units.
#[derive(Debug)]
pub(super) struct FlowControl {
    axis: usize,
    /// The bulk velocity.
    target: f64,
    /// What the scene has everywhere.
    base: [f64; 3],
    /// r, a step.
    rate: f64,
    /// What a smooth wall takes: the force at the start.
    usual: f64,
    state: FlowControlState,
}

/// The parts of the force between two steps, lattice units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct FlowControlState {
    /// I.
    pub integral: f64,
    /// F.
    pub force: f64,
}

impl FlowControlState {
    fn start(force: f64) -> Self {
        Self {
            integral: force,
            force,
        }
    }
}

impl FlowControl {
    /// That of a scene with a bulk velocity.
    pub fn new(scene: &Scene, units: &Units) -> Option<Self> {
        let (axis, velocity) = scene.fluid.kept_velocity()?;
        let target = units.velocity_to_lattice(velocity);
        let constant = scene.fluid.acceleration.each_ref().map(|a| a.constant());
        let base = constant.map(|a| units.acceleration_to_lattice(a.unwrap_or_default()));
        // Half the distance of the closest pair of walls; without walls that of the faces.
        let cells = scene.cells().map(f64::from);
        let between = (0..3).filter(|&other| other != axis).filter(|&other| {
            let faces = &scene.boundaries;
            let mut pair = Face::ALL[2 * other..2 * other + 2].iter();
            pair.any(|face| matches!(faces.face(*face), Boundary::Wall { .. }))
        });
        let across = between.map(|other| cells[other]).reduce(f64::min);
        let half = 0.5 * across.unwrap_or(cells[axis]);
        let viscosity = units.viscosity_to_lattice(scene.fluid.viscosity);
        // Friction velocities are a twentieth of the bulk velocity, or what the laminar flow has.
        let usual =
            target * target.abs() / (400.0 * half) + 3.0 * viscosity * target / (half * half);
        Some(Self {
            axis,
            target,
            base,
            rate: (usual / target).max(0.25 / TIME),
            usual,
            state: FlowControlState::start(usual),
        })
    }

    /// The mean velocity along the axis, cells a step.
    pub fn bulk_velocity(&self, sums: &Sums) -> f64 {
        sums.momentum[self.axis] / (sums.cells + sums.excess).max(1.0)
    }

    /// The force per mass that keeps it, lattice units.
    pub fn acceleration(&self) -> f64 {
        self.state.force
    }

    pub fn state(&self) -> FlowControlState {
        self.state
    }

    /// Follows a bulk velocity.
    fn follow(&mut self, velocity: f64) {
        let error = self.target - velocity;
        let integral = self.state.integral + error * STEPS as f64 * self.rate / TIME;
        let most = LARGEST * self.usual.abs();
        self.state.integral = integral.clamp(-most, most);
        self.state.force = self.state.integral + error / TIME;
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

    /// Measures the bulk velocity, if that is due, and gives the fluid the force that keeps it.
    pub(super) async fn control_flow(&mut self) -> Result<()> {
        if !self.control_due() {
            return Ok(());
        }
        let (device, queue) = (&self.device, &self.queue);
        let sums = self.observer.sums(device, queue, &mut self.lattice).await?;
        if let Some(control) = &mut self.flow_control {
            let velocity = control.bulk_velocity(&sums);
            // A flow that has left the range of the method is found by the guard.
            if velocity.is_finite() {
                control.follow(velocity);
            }
        }
        self.apply_flow_control()
    }

    /// Continues from a state; without one the control begins anew.
    pub(super) fn restore_flow_control(&mut self, state: Option<FlowControlState>) -> Result<()> {
        if let Some(control) = &mut self.flow_control {
            control.state = state.unwrap_or(FlowControlState::start(control.usual));
        }
        self.apply_flow_control()
    }

    /// Gives the fluid the present force, and the blocks what it does on the fluid in them.
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
