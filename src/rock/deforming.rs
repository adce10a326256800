//! Deformable blocks: their deformation and motion.
//!
//! They are in the lists of all blocks like rigid ones, so that contacts, pairs and output need no distinction.
//! Their deformations are in separate lists, which are empty in scenes of rigid blocks.

use super::{
    Block, Blocks, Body, Material,
    body::{MidStep, State},
    contact_list::ContactList,
    threads,
};
use crate::{
    geometry::{Form, Pose, outer},
    rock::{
        integrate::{self, Affine, PointConstraints, Wrench, axial},
        law,
    },
};
use glam::{DMat3, DVec3};
use rayon_cond::CondIterator;

/// Number of evaluations of the viscous stress at the end of a step.
const PASSES: usize = 4;

/// Index that marks a rigid block.
pub(super) const RIGID: u32 = u32::MAX;

/// Constants of a deformable block.
#[derive(Clone, Debug)]
pub(super) struct Deforming {
    /// Index among all blocks.
    pub block: usize,
    pub affine: Affine,
    pub constraints: PointConstraints,
    /// Largest lever arm of a vertex, m.
    pub reach: f64,
}

/// State of a deformable block between two steps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Strain {
    /// F.
    pub deformation: DMat3,
    /// Ḟ, 1/s.
    pub rate: DMat3,
    /// Σ f ⊗ r of the contacts, N m.
    pub moment: DMat3,
    /// Σ f ⊗ r of the external load, N m.
    pub load: DMat3,
    /// F when the pairs were found.
    pub skin_reference: DMat3,
}

impl Default for Strain {
    /// No deformation, at rest. Not derived, because the default of a matrix is the identity.
    fn default() -> Self {
        Self {
            deformation: DMat3::IDENTITY,
            rate: DMat3::ZERO,
            moment: DMat3::ZERO,
            load: DMat3::ZERO,
            skin_reference: DMat3::IDENTITY,
        }
    }
}

impl Strain {
    /// ∂v/∂x, 1/s.
    pub fn gradient(&self) -> DMat3 {
        self.rate * self.deformation.inverse()
    }

    /// Whether it is finite and has det F > 0.
    pub fn is_sound(&self) -> bool {
        self.rate.is_finite()
            && self.deformation.is_finite()
            && self.deformation.determinant() > 0.0
    }
}

/// Pose and motion of a block.
pub(super) fn pose(body: &Body, state: &State, strains: &[Strain]) -> Pose {
    if body.deforming == RIGID {
        return state.pose();
    }
    let strain = &strains[body.deforming as usize];
    Pose {
        centre: state.centre,
        deformation: strain.deformation,
        velocity: state.velocity,
        deformation_rate: strain.rate,
    }
}

/// Result of the first half of a step of a deformable block.
#[derive(Clone, Copy, Debug, Default)]
struct TrialStep {
    state: State,
    mid_step: MidStep,
    /// ∂v/∂x, 1/s: the mean over the step, and the value expected at its end.
    gradients: [DMat3; 2],
}

/// All deforming blocks, in the order of the blocks.
#[derive(Clone, Debug, Default)]
pub(super) struct DeformingBlocks {
    pub list: Vec<Deforming>,
    pub strains: Vec<Strain>,
    /// Results of a step until it is known to be valid.
    pub next: Vec<Strain>,
    trials: Vec<TrialStep>,
}

/// Parameters of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepParams {
    /// m/s².
    pub gravity: DVec3,
    /// α, 1/s.
    pub damping: f64,
    /// Interval over which the loads of a fluid are constant, s; zero without a fluid.
    pub load_interval: f64,
    /// Time at the start of the step, s.
    pub time: f64,
    /// s.
    pub dt: f64,
}

impl DeformingBlocks {
    /// Adds the block `index`, if it is deformable; returns its index among the deformable blocks, or [`RIGID`].
    pub fn add(&mut self, index: usize, block: &Block, material: &Material) -> u32 {
        let (Some(deformable), Some(elastic)) = (&block.deformable, material.elastic) else {
            return RIGID;
        };
        let turn = DMat3::from_quat(block.rotation.normalize());
        let affine = Affine::new(
            block.shape.volume(),
            block.shape.inertia(),
            material.density,
            elastic,
            turn.transpose() * deformable.initial_stress * turn,
        );
        let points = deformable.fixed_points.iter();
        let start = Pose::rigid(
            block.centre,
            block.rotation.normalize(),
            block.velocity,
            block.spin,
        );
        let constraints = PointConstraints::new(
            &affine,
            (start.centre, start.deformation),
            points.map(|constraints| (constraints.point, constraints.axes)),
        );
        self.strains.push(Strain {
            deformation: start.deformation,
            rate: start.deformation_rate,
            ..Strain::default()
        });
        self.next = self.strains.clone();
        self.trials.push(TrialStep::default());
        let forms = block.shape.parts().iter().map(|part| &part.form);
        let vertices = forms.flat_map(|form| match form {
            Form::Convex(polyhedron) => polyhedron.vertices(),
            Form::Sphere { .. } => &[],
        });
        let reach = vertices.map(|v| affine.lever(*v)).fold(0.0, f64::max);
        self.list.push(Deforming {
            block: index,
            affine,
            constraints,
            reach,
        });
        self.list.len() as u32 - 1
    }

    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Constants and state of the deformable block `body`; `None` if it is rigid.
    pub fn of(&self, body: &Body) -> Option<(&Deforming, &Strain)> {
        let k = body.deforming as usize;
        (body.deforming != RIGID).then(|| (&self.list[k], &self.strains[k]))
    }

    /// Trial state of the deformable block `body` in the present step; `None` if it is rigid.
    pub fn of_next(&self, body: &Body) -> Option<&Strain> {
        (body.deforming != RIGID).then(|| &self.next[body.deforming as usize])
    }

    /// ∂v/∂x of `body` over the present step and as expected at its end, 1/s.
    pub fn gradients(&self, body: &Body) -> Option<&[DMat3; 2]> {
        (body.deforming != RIGID).then(|| &self.trials[body.deforming as usize].gradients)
    }

    /// Arm and width, m, of a contact of `width` (m) at `arm` (m from the centroid, world) in the bound of
    /// the time step: unchanged for a rigid block. A deformable block has its lever against the smallest
    /// second moment, and no section of it extends beyond its vertices.
    pub fn lever(&self, body: &Body, arm: DVec3, width: f64) -> (DVec3, f64) {
        let Some((one, strain)) = self.of(body) else {
            return (arm, width);
        };
        let lever = one.affine.lever(strain.deformation.inverse() * arm);
        (DVec3::X * lever.hypot(0.5 * width).min(one.reach), 0.0)
    }

    /// Speed of the fastest point of a block, m/s, or an upper bound of it.
    pub fn fastest(&self, body: &Body, state: &State) -> f64 {
        match self.of(body) {
            None => state.fastest(body.radius),
            Some((_, strain)) => state.velocity.length() + norm(strain.rate) * body.radius,
        }
    }

    /// Spin of a face of a block with this unit normal, rad/s, without that of a deformable block about the normal.
    pub fn face_spin(&self, body: &Body, state: &State, normal: DVec3) -> DVec3 {
        match self.of(body) {
            None => state.spin,
            Some((_, strain)) => -normal.cross(strain.gradient().transpose() * normal),
        }
    }

    /// Upper bound of the displacement of all points of a block by its deformation since the pairs were found, m.
    pub fn moved_by_strain(&self, body: &Body) -> Option<f64> {
        let (_, strain) = self.of(body)?;
        Some(norm(strain.deformation - strain.skin_reference) * body.radius)
    }

    /// Records the present deformations, at which the pairs were found.
    pub fn set_skin_reference(&mut self) {
        for strain in &mut self.strains {
            strain.skin_reference = strain.deformation;
        }
    }

    /// Sets the motion before the first step.
    pub fn at_start(&mut self) {
        for (trial, strain) in self.trials.iter_mut().zip(&self.strains) {
            trial.gradients = [DMat3::ZERO, strain.gradient()];
        }
        self.next.clone_from(&self.strains);
    }

    /// Kick and drift of all deformable blocks over a step, into `states` and `mid_steps`. Returns the first block whose
    /// state is not finite or has det F ≤ 0.
    pub fn kick_drift(
        &mut self,
        bodies: &[Body],
        before: &[State],
        params: StepParams,
        states: &mut [State],
        mid_steps: &mut [MidStep],
    ) -> Option<usize> {
        let all =
            CondIterator::new(&self.list, self.list.len() >= threads::PAIRS).zip(&self.strains);
        let all = all.zip(&mut self.next).zip(&mut self.trials);
        let lost = all.filter_map(|(((one, strain), next), trial)| {
            let body = &bodies[one.block];
            *trial = one.kick_drift(body, &before[one.block], strain, next, params);
            (!trial.state.is_finite() || !next.is_sound()).then_some(one.block)
        });
        let lost = lost.min();
        for (one, trial) in self.list.iter().zip(&self.trials) {
            states[one.block] = trial.state;
            mid_steps[one.block] = trial.mid_step;
        }
        lost
    }

    /// Sums the moments Σ f ⊗ r of the contacts.
    pub fn sum_contact_moments(
        &mut self,
        bodies: &[Body],
        contacts: &ContactList,
        states: &[State],
    ) {
        if self.is_empty() {
            return;
        }
        for strain in &mut self.strains {
            strain.moment = DMat3::ZERO;
        }
        for contact in contacts.iter() {
            let places = [
                contact.pressure_centre,
                contact.pressure_centre - contact.image_shift,
            ];
            let ends = contact.blocks.into_iter().zip(places);
            for ((block, at), sign) in ends.zip([-1.0, 1.0]) {
                let k = bodies[block as usize].deforming;
                if k == RIGID {
                    continue;
                }
                let arm = at - states[block as usize].centre;
                // A torque is the skew part of a moment. The springs of a bond act along its normal: their moment is in power with
                // the rotation of the normal, to which shear of the block contributes.
                let moment = outer(contact.force.total(), arm)
                    + couple(contact.force.moment + contact.force.torsion)
                    + outer(contact.normal, contact.normal.cross(contact.force.bending));
                self.strains[k as usize].moment += moment * sign;
            }
        }
    }

    /// The second kick of a step, with the forces at its end.
    pub fn second_kick(&mut self, bodies: &[Body], params: StepParams, states: &mut [State]) {
        for (one, strain) in self.list.iter().zip(&mut self.strains) {
            one.second_kick(&bodies[one.block], &mut states[one.block], strain, params);
        }
    }
}

/// Acceleration of a deformable block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Acceleration {
    /// Acceleration of the centroid, m/s².
    pub centre: DVec3,
    /// F̈, 1/s².
    pub deformation: DMat3,
    /// Force of the fixed points on the block, N.
    pub support: DVec3,
}

impl Deforming {
    /// Acceleration at the time `t`, s.
    pub fn accelerations(
        &self,
        body: &Body,
        state: &State,
        strain: &Strain,
        (gravity, load_interval): (DVec3, f64),
        t: f64,
    ) -> Acceleration {
        let mut wrench = Wrench {
            force: state.force + state.load,
            moment: strain.moment + strain.load,
        };
        if let Some(applied_forces) = body.applied_forces() {
            let more = applied_forces.wrench(strain.deformation, body.mass, t);
            wrench.force += more.force;
            wrench.moment += more.moment;
        }
        let (rate, mut turning) = self.affine.accelerations(strain.deformation, &wrench);
        if load_interval > 0.0 {
            turning += self.affine.retarding(strain.deformation, strain.rate)
                * self.affine.retardation(load_interval);
        }
        let free = rate + gravity;
        let (centre, deformation) = self.constraints.project((free, turning));
        Acceleration {
            centre,
            deformation,
            support: body.mass * (centre - free),
        }
    }

    fn kick_drift(
        &self,
        body: &Body,
        before: &State,
        strain: &Strain,
        next: &mut Strain,
        StepParams {
            gravity,
            damping,
            load_interval,
            time,
            dt,
        }: StepParams,
    ) -> TrialStep {
        let given = (gravity, load_interval);
        let rate = self.accelerations(body, before, strain, given, time);
        let velocity = integrate::first_kick(before.velocity, rate.centre, damping, dt);
        let half = integrate::first_kick(strain.rate, rate.deformation, damping, dt);
        let mut state = *before;
        let drifted = (
            before.centre + velocity * dt,
            strain.deformation + half * dt,
        );
        let (centre, deformation) = self.constraints.place(drifted);
        (state.centre, state.velocity) = (centre, velocity);
        *next = Strain {
            deformation,
            rate: half,
            ..*strain
        };
        let inverse = next.deformation.inverse();
        // An inverted block has no rotation; its step is refused.
        if next.is_sound() {
            let rotation = integrate::polar(next.deformation);
            // Of the two quaternions ±q, the one that continues the last rotation.
            let follows = rotation.dot(before.rotation) >= 0.0;
            state.rotation = if follows { rotation } else { -rotation };
        }
        let gradients = [half * inverse, (half * 2.0 - strain.rate) * inverse];
        let [spin, end_spin] = gradients.map(|gradient| 0.5 * axial(gradient));
        TrialStep {
            mid_step: MidStep {
                velocity,
                spin,
                end_velocity: 2.0 * velocity - before.velocity,
                end_spin,
                ..MidStep::at_rest(body, &state)
            },
            state,
            gradients,
        }
    }

    fn second_kick(&self, body: &Body, state: &mut State, strain: &mut Strain, params: StepParams) {
        let StepParams {
            gravity,
            damping,
            load_interval,
            time,
            dt,
        } = params;
        // The viscous stress depends on the rate at the end of the step. Each pass reduces the error to a tenth or less.
        let passes = if load_interval > 0.0 { PASSES } else { 1 };
        let (velocity, half) = (state.velocity, strain.rate);
        for _ in 0..passes {
            let given = (gravity, load_interval);
            let rate = self.accelerations(body, state, strain, given, time + dt);
            state.velocity = integrate::second_kick(velocity, rate.centre, damping, dt);
            strain.rate = integrate::second_kick(half, rate.deformation, damping, dt);
        }
        state.momentum = self
            .affine
            .angular_momentum(strain.deformation, strain.rate);
        state.spin = 0.5 * axial(strain.gradient());
    }
}

/// The moment Σ f ⊗ r of a pure torque (N m).
pub(super) fn couple(torque: DVec3) -> DMat3 {
    crate::geometry::skew(torque) * 0.5
}

/// Frobenius norm, an upper bound of the growth of any vector.
pub(super) fn norm(a: DMat3) -> f64 {
    let columns = [a.x_axis, a.y_axis, a.z_axis];
    columns
        .iter()
        .map(|c| c.length_squared())
        .sum::<f64>()
        .sqrt()
}

impl Blocks {
    /// Whether any block is deformable.
    pub fn any_deforms(&self) -> bool {
        !self.deforming.is_empty()
    }

    /// Cauchy stress in a deformable block, along the axes of the world, Pa; tension is positive.
    pub fn stress(&self, block: usize) -> Option<DMat3> {
        let (one, strain) = self.deforming.of(&self.bodies[block])?;
        Some(one.affine.stress(strain.deformation))
    }

    /// Von Mises stress in a deformable block, Pa.
    pub fn von_mises(&self, block: usize) -> Option<f64> {
        self.stress(block).map(law::von_mises)
    }

    /// Strain E = ½(FᵀF − 1) of a deformable block, in its own frame.
    pub fn strain(&self, block: usize) -> Option<DMat3> {
        let (one, strain) = self.deforming.of(&self.bodies[block])?;
        Some(one.affine.strain(strain.deformation))
    }

    /// Strain energy of a deformable block, J.
    pub fn strain_energy(&self, block: usize) -> Option<f64> {
        let (one, strain) = self.deforming.of(&self.bodies[block])?;
        Some(one.affine.strain_energy(strain.deformation))
    }

    /// Force of the fixed points on a block, N; `None` if it has no fixed points.
    pub fn support(&self, block: usize) -> Option<DVec3> {
        let body = &self.bodies[block];
        let (one, strain) = self.deforming.of(body)?;
        let state = &self.states[block];
        let given = (self.gravity, self.load_interval);
        let rate = one.accelerations(body, state, strain, given, self.time);
        (!one.constraints.is_empty()).then_some(rate.support)
    }
}
