//! All blocks of a scene and their state.

use super::{
    Body, ContactPoint, EnergyLedger, Setup, Sleep,
    body::{self, MidStep, State},
    candidate_pairs::{CandidatePair, PlacedParts, SkinReference, usual_skin},
    check,
    contact_list::{ContactList, ContactSum},
    deforming::{DeformingBlocks, pose},
    energy::{BodyStates, WorkSums},
    films::Films,
    narrowphase::Joints,
    period::Periods,
    resolver_pool::ResolverPool,
    step::{StepTimes, is_time},
    time_step,
};
use crate::{
    Error, Result,
    geometry::{Load, Pose},
    rock::{
        broadphase::Broadphase,
        contact::{Counts, Options},
        integrate,
        law::{self, Joint},
    },
};
use glam::{DQuat, DVec3};
use std::time::Instant;

/// Blocks that move under gravity, loads and each other's contacts.
///
/// ```
/// use glam::DVec3;
/// use riprap::{geometry::{Polyhedron, Shape}, rock::{Block, Blocks, Material, Setup}};
/// use std::sync::Arc;
///
/// # fn main() -> riprap::Result<()> {
/// // A cube of 1 m falls for 0.1 s.
/// let shape: Arc<Shape> = Arc::new(Polyhedron::cuboid(DVec3::ONE)?.into());
/// let mut blocks = Blocks::new(Setup {
///     blocks: vec![Block::new("cube", shape, DVec3::Z)],
///     materials: vec![Material::default()],
///     time_step: Some(1e-3),
///     ..Setup::default()
/// })?;
/// for _ in 0..100 {
///     if blocks.needs_pairs() {
///         blocks.set_pairs(Vec::new())?; // It is alone.
///     }
///     blocks.step()?;
/// }
/// assert!((blocks.poses()[0].centre.z - (1.0 - 0.5 * 9.81 * 0.01)).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Blocks {
    pub(super) bodies: Vec<Body>,
    pub(super) joints: Joints,
    pub(super) gravity: DVec3,
    pub(super) damping: f64,
    /// Interval over which the loads of a fluid are constant, s.
    pub(super) load_interval: f64,
    /// Whether the setup prescribes the time step.
    pub(super) given_step: bool,
    /// ω² and index of the stiffest block by its faces.
    pub(super) stiffest: (f64, usize),
    pub(super) skin: f64,
    pub(super) sleep: Option<Sleep>,
    pub(super) start_overlap: f64,
    pub(super) largest_overlap: f64,
    pub(super) corner_area: f64,
    /// Periodic axes of the domain.
    pub(super) periods: Option<Periods>,
    /// Fluid in thin gaps.
    pub(super) film: Option<law::Film>,
    pub(super) resolver_pool: ResolverPool,

    pub(super) time: f64,
    pub(super) steps: u64,
    pub(super) peak_speed: f64,
    pub(super) time_step: f64,
    pub(super) started: bool,
    pub(super) states: Vec<State>,
    pub(super) deforming: DeformingBlocks,
    /// Poses when the pairs were found; empty before the first search.
    pub(super) skin_references: Vec<SkinReference>,
    pub(super) pairs: Vec<CandidatePair>,
    pub(super) contacts: ContactList,
    pub(super) work_sums: WorkSums,

    // Results of a step until it is known to be valid; then each `next_…` is swapped with the present state.
    pub(super) parts: PlacedParts,
    pub(super) mid_steps: Vec<MidStep>,
    pub(super) contact_sums: Vec<ContactSum>,
    pub(super) films: Films,
    /// Energy taken by the films in this step, J.
    pub(super) film_work: f64,
    pub(super) next_states: Vec<State>,
    pub(super) next_pairs: Vec<CandidatePair>,
    pub(super) next_contacts: ContactList,
    /// Times of the phases of steps, if requested.
    pub(super) step_times: Option<StepTimes>,
}

impl Blocks {
    /// Creates the blocks at t = 0.
    ///
    /// # Errors
    /// [`Error::Argument`] naming a block without mass, a pose that is not finite, a material that does not
    /// exist or is invalid.
    pub fn new(setup: Setup) -> Result<Self> {
        Self::with_options(setup, Options::default())
    }

    /// Like [`Blocks::new`], with contacts resolved by `options`.
    ///
    /// # Errors
    /// The errors of [`Blocks::new`].
    pub fn with_options(setup: Setup, options: Options) -> Result<Self> {
        check::check(&setup)?;
        let joints = check::joints(&setup);
        let (bodies, states, deforming) = body::make(&setup);
        let stiffest = time_step::of_shapes(&bodies, &deforming, &joints);
        let usual = law::longest_step(law::USUAL_SHARE, stiffest.0);
        let time_step = setup.time_step.unwrap_or(usual);
        let mut blocks = Self {
            skin: setup.skin.unwrap_or_else(|| usual_skin(&bodies)),
            joints,
            gravity: setup.gravity,
            damping: setup.damping,
            load_interval: 0.0,
            given_step: setup.time_step.is_some(),
            stiffest,
            sleep: setup.sleep,
            start_overlap: setup.start_overlap,
            largest_overlap: setup.largest_overlap,
            corner_area: setup.corner_area,
            film: setup.film,
            periods: None,
            resolver_pool: ResolverPool::new(options),
            time: 0.0,
            steps: 0,
            peak_speed: 0.0,
            time_step,
            started: false,
            skin_references: Vec::new(),
            pairs: Vec::new(),
            contacts: ContactList::default(),
            work_sums: WorkSums::default(),
            parts: PlacedParts::new(&bodies),
            mid_steps: vec![MidStep::default(); bodies.len()],
            contact_sums: Vec::new(),
            films: Films::default(),
            film_work: 0.0,
            next_states: states.clone(),
            next_pairs: Vec::new(),
            next_contacts: ContactList::default(),
            step_times: None,
            bodies,
            states,
            deforming,
        };
        blocks.place();
        if let Some(period) = setup.period {
            blocks.repeat(period, &setup.blocks)?;
        }
        Ok(blocks)
    }

    /// Number of blocks.
    pub fn len(&self) -> usize {
        self.bodies.len()
    }

    /// Whether there is no block.
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// Time, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Number of steps done.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Largest speed of a centroid after any step since these blocks were made, m/s.
    pub fn peak_speed(&self) -> f64 {
        self.peak_speed
    }

    /// Begins the search for the largest speed anew, after a trial step.
    pub(crate) fn reset_peak_speed(&mut self) {
        self.peak_speed = 0.0;
    }

    /// Time step of [`Blocks::step`], and the longest one of [`Blocks::advance`], s.
    pub fn time_step(&self) -> f64 {
        self.time_step
    }

    /// Distance below which pairs are candidates, m.
    pub fn skin(&self) -> f64 {
        self.skin
    }

    /// Poses of all blocks, with their velocities.
    pub fn poses(&self) -> Vec<Pose> {
        let all = self.bodies.iter().zip(&self.states);
        let strains = &self.deforming.strains;
        all.map(|(body, state)| pose(body, state, strains))
            .collect()
    }

    /// Pose of one block.
    pub(crate) fn pose(&self, block: usize) -> Pose {
        pose(
            &self.bodies[block],
            &self.states[block],
            &self.deforming.strains,
        )
    }

    /// Name of a block; empty if there is no such block.
    pub fn name(&self, block: usize) -> &str {
        self.bodies.get(block).map_or("", |body| &body.name)
    }

    /// Mass of a block, kg; NaN if there is no such block.
    pub fn mass(&self, block: usize) -> f64 {
        self.bodies.get(block).map_or(f64::NAN, |body| body.mass)
    }

    /// Rotation of a block; NaN if there is no such block.
    pub fn rotation(&self, block: usize) -> DQuat {
        let state = self.states.get(block);
        state.map_or(DQuat::NAN, |state| state.rotation)
    }

    /// Spins about the world's axes, rad/s.
    pub fn spins(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.states.iter().map(|state| state.spin)
    }

    /// Angular momentum of a free block about its centroid, world, kg m²/s; NaN if there is no such block.
    pub fn angular_momentum(&self, block: usize) -> DVec3 {
        let state = self.states.get(block);
        state.map_or(DVec3::NAN, |state| state.momentum)
    }

    /// Net force of the contacts on each block, N.
    pub fn contact_forces(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.states.iter().map(|state| state.force)
    }

    /// Net torque of the contacts on each block about its centroid, N m.
    pub fn contact_torques(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.states.iter().map(|state| state.torque)
    }

    /// Mean force of the fluid films on each block over the second half of the last step, N.
    pub fn film_forces(&self) -> Vec<DVec3> {
        let mut forces = vec![DVec3::ZERO; self.len()];
        for &(block, force) in &self.films.forces {
            forces[block as usize] = force;
        }
        forces
    }

    /// External force, N, and torque about the centroid, N m, on each block.
    pub fn loads(&self) -> impl Iterator<Item = [DVec3; 2]> + '_ {
        let each = self.states.iter();
        each.map(|state| [state.load, state.load_torque])
    }

    /// Whether each block is asleep.
    pub fn asleep(&self) -> impl Iterator<Item = bool> + '_ {
        self.states.iter().map(|state| state.asleep)
    }

    /// Whether a block exists and can move, being free or driven.
    pub fn moves(&self, block: usize) -> bool {
        self.bodies.get(block).is_some_and(|body| !body.is_fixed())
    }

    /// Whether each movable block sleeps, or may fall asleep within the next `time` (s).
    pub fn may_all_sleep_within(&self, time: f64) -> bool {
        let Some(sleep) = &self.sleep else {
            return false;
        };
        let mut all = self.bodies.iter().zip(&self.states);
        all.all(|(body, state)| {
            let soon = body.may_sleep() && state.slow + time >= sleep.after;
            body.is_fixed() || state.asleep || soon
        })
    }

    /// Speed of the fastest point of a free block, m/s.
    pub fn largest_speed(&self) -> f64 {
        let free = self.bodies.iter().zip(&self.states);
        free.filter(|(body, _)| body.is_free())
            .map(|(body, state)| self.deforming.fastest(body, state))
            .fold(0.0, f64::max)
    }

    /// The contacts at the end of the last step, in the order of the pairs.
    pub fn contacts(&self) -> impl Iterator<Item = ContactPoint> + '_ {
        let real = self.contacts.iter().filter(|contact| contact.area > 0.0);
        real.map(ContactPoint::of)
    }

    /// The joint between two blocks, by their materials.
    ///
    /// # Panics
    /// If there is no such block.
    pub fn joint(&self, [a, b]: [usize; 2]) -> &Joint {
        let material = |block: usize| self.bodies[block].material;
        self.joints.of(material(a), material(b))
    }

    /// Gravity, m/s².
    pub fn gravity(&self) -> DVec3 {
        self.gravity
    }

    /// Force, N, and torque about the centroid, N m, of the present applied loads of a block: its point loads, and its
    /// mass times its acceleration.
    pub(crate) fn applied_load(&self, block: usize) -> [DVec3; 2] {
        let body = &self.bodies[block];
        let Some(applied_forces) = body.applied_forces() else {
            return [DVec3::ZERO; 2];
        };
        let pose = pose(body, &self.states[block], &self.deforming.strains);
        let wrench = applied_forces.wrench(pose.deformation, body.mass, self.time);
        [wrench.force, integrate::axial(wrench.moment)]
    }

    /// Energies since the start.
    pub fn ledger(&self) -> EnergyLedger {
        self.work_sums
            .ledger(self.all(), &self.contacts, self.gravity)
    }

    /// Counters of the contact resolvers, summed over all threads.
    pub fn counts(&self) -> Counts {
        self.resolver_pool.counts()
    }

    /// Number of candidate pairs.
    pub fn candidate_pair_count(&self) -> usize {
        self.pairs.len()
    }

    /// Sets the interval (s) over which the external loads are constant, zero at the start. The load of a fluid lags behind the
    /// motion: on a strain that vibrates faster than the interval resolves, it does work that grows. Such strains of deformable
    /// blocks have viscous stresses, up to critical damping where ω times the interval is above 2, and follow the loads.
    pub fn set_load_interval(&mut self, interval: f64) {
        self.load_interval = interval;
    }

    /// Sets the external loads of all blocks, which act until they are set again.
    ///
    /// # Errors
    /// [`Error::Argument`] if their number differs from that of the blocks, or one is not finite.
    pub fn set_loads(&mut self, loads: &[Load]) -> Result<()> {
        if loads.len() != self.len() {
            let message = format!("{} loads for {} blocks", loads.len(), self.len());
            return Err(Error::argument("loads", message));
        }
        let finite = |load: &Load| load.force.is_finite() && load.moment.is_finite();
        if let Some(i) = loads.iter().position(|load| !finite(load)) {
            let message = format!("the load {:?} is not finite", loads[i].force);
            return Err(Error::argument(self.label(i), message));
        }
        for (state, load) in self.states.iter_mut().zip(loads) {
            state.load = load.force;
            state.load_torque = load.torque();
        }
        let deforming = &mut self.deforming;
        for (one, strain) in deforming.list.iter().zip(&mut deforming.strains) {
            strain.load = loads[one.block].moment;
        }
        let all = BodyStates {
            bodies: &self.bodies,
            states: &self.states,
            deforming: &self.deforming,
        };
        self.work_sums.reload(all, self.time);
        self.wake();
        Ok(())
    }

    /// Advances to the time `until` (s), in equal steps of at most the time step, with new pairs from
    /// `broadphase` when needed.
    ///
    /// # Errors
    /// The errors of [`Blocks::step`] and of the broadphase, and [`Error::Argument`] if that time is not finite.
    pub async fn advance(&mut self, broadphase: &mut impl Broadphase, until: f64) -> Result<()> {
        is_time(until)?;
        while self.time < until {
            if self.needs_pairs() {
                let start = self.step_times.map(|_| Instant::now());
                if let Some(bad) = self.states.iter().position(|state| !state.is_finite()) {
                    return Err(self.not_finite(bad, self.time));
                }
                let pairs = broadphase.pairs(&self.aabbs()).await?;
                self.set_pairs(pairs)?;
                if let (Some(times), Some(start)) = (&mut self.step_times, start) {
                    times.broadphase += start.elapsed().as_secs_f64();
                }
            }
            self.step_known(self.substep_to(until))?;
        }
        Ok(())
    }

    /// Measures the times of the phases of steps from now on.
    pub fn time_phases(&mut self) {
        self.step_times.get_or_insert_default();
    }

    /// Times of the phases of steps; `None` unless requested by [`Blocks::time_phases`].
    pub fn step_times(&self) -> Option<StepTimes> {
        self.step_times
    }

    /// Sets the time to `until` (s), if that is later, without motion.
    ///
    /// # Errors
    /// [`Error::Argument`] if that time is not finite.
    pub fn skip_to(&mut self, until: f64) -> Result<()> {
        is_time(until)?;
        self.time = self.time.max(until);
        Ok(())
    }

    /// All blocks with their state.
    fn all(&self) -> BodyStates<'_> {
        BodyStates {
            bodies: &self.bodies,
            states: &self.states,
            deforming: &self.deforming,
        }
    }

    /// The name of a block for a message.
    pub(super) fn label(&self, block: usize) -> String {
        super::narrowphase::label(block, &self.bodies[block].name)
    }
}
