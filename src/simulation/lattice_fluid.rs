//! A fluid on a lattice, coupled to the blocks in it.

use super::{
    checkpoint::{LatticeState, differ, other_scene},
    flow_control::FlowControl,
    statistics::Sampling,
};
use crate::{
    Error, Result,
    coupling::{
        Coupled, ExchangeInterval, Fluid, FluidLoad, LatticeCoupling, Rock, check_substep_count,
        couple,
    },
    error::{error_chain, refused},
    geometry::Pose,
    gpu::timer::{Phases, begin_pass},
    lattice::{self, Collision, Derived, Lattice, Observer, Setup, State},
    scene::{
        Advice, Boundary, Face, SUGA_EXCESS, Scene,
        build::{block_setup, face_density, face_velocity, lattice_key},
    },
    units::Units,
};
use std::{sync::Arc, time::Instant};

/// The fluid of a scene, and its coupling to the blocks.
#[derive(Debug)]
pub(super) struct LatticeFluid {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub scene: Arc<Scene>,
    pub units: Units,
    pub lattice: Lattice,
    pub observer: Observer,
    /// Velocity and pressure faces whose formulas contain the time.
    time_dependent_faces: Vec<Face>,
    /// The coupling to the blocks in it, if there are any.
    pub coupling: Option<LatticeCoupling>,
    /// Field statistics, if the scene outputs any.
    pub sampling: Option<Sampling>,
    /// Controller of the bulk velocity, if the scene prescribes one.
    pub flow_control: Option<FlowControl>,
    /// Times of the phases of a step, if requested.
    pub phases: Option<Phases>,
}

impl LatticeFluid {
    /// Compiles the kernels of a scene and sets its initial state. Also returns the blocks in the fluid and warnings about them.
    ///
    /// # Errors
    /// If the scene is incomplete, or the device cannot hold it.
    pub async fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        (scene, units): (&Arc<Scene>, Units),
        setup: Setup,
    ) -> Result<(Self, Option<Rock>, Advice)> {
        let mut start = start(scene, &units)?;
        let time_dependent = |(face, boundary): (Face, &Boundary)| match boundary {
            Boundary::Velocity { velocity, .. } if velocity.iter().any(|f| f.uses_time()) => {
                Some(face)
            }
            Boundary::Pressure { pressure, .. } if pressure.uses_time() => Some(face),
            _ => None,
        };
        let make = async {
            let mut lattice =
                Lattice::new(device, setup).map_err(|error| error.at_key(lattice_key))?;
            let observer = Observer::new(device, &lattice)?;
            let sampling =
                Sampling::new(device, (scene, units.time_step), &mut lattice, &observer)?;
            let mut advice = Advice::new();
            let mut blocks = None;
            if scene.has_blocks() {
                let setup = block_setup(scene)?;
                let (rock, coupling) =
                    couple(device, queue, &lattice, (scene, &units), setup).await?;
                check_substep_count(units.time_step, rock.blocks())?;
                let coupled = Coupled::new(&rock, &coupling);
                advice = coupled.advise(scene);
                coupled.set_interior_velocity(&scene.domain, &mut start);
                blocks = Some((rock, coupling));
            }
            lattice
                .start(device, queue, &start, true)
                .map_err(|error| error.at_key(lattice_key))?;
            Ok((lattice, observer, sampling, blocks, advice))
        };
        let (made, refused) = refused(device, make).await;
        let (lattice, observer, sampling, blocks, advice) = made?;
        if let Some(error) = refused {
            let bytes: u64 = lattice.bytes().iter().map(|(_, bytes)| bytes).sum();
            return Err(Error::Device(format!(
                "it does not hold {} cells, {bytes} bytes in its buffers ({}); use a larger cell or 16-bit storage",
                lattice.grid().cell_count(),
                error_chain(&error)
            )));
        }
        let (rock, coupling) = blocks.unzip();
        let mut fluid = Self {
            device: device.clone(),
            queue: queue.clone(),
            time_dependent_faces: scene.boundaries.iter().filter_map(time_dependent).collect(),
            scene: scene.clone(),
            units,
            lattice,
            observer,
            coupling,
            sampling,
            flow_control: FlowControl::new(scene, &units),
            phases: None,
        };
        fluid.apply_flow_control()?;
        Ok((fluid, rock, advice))
    }

    /// The blocks in it, if there are any.
    pub fn coupled<'a>(&'a self, rock: Option<&'a Rock>) -> Option<Coupled<'a>> {
        Some(Coupled::new(rock?, self.coupling.as_ref()?))
    }

    /// Which cells are solid, x fastest; empty if none are.
    pub fn solid(&self) -> &[bool] {
        &self.lattice.setup().solid
    }

    /// Advances a fluid without blocks to the time `end` (s).
    ///
    /// # Errors
    /// The errors of face formulas.
    pub async fn run(&mut self, end: f64) -> Result<()> {
        while self.time() < end {
            self.advance(&[], ExchangeInterval::Static, end).await?;
        }
        Ok(())
    }

    /// Checks that the flow is within the range of the method, after an advance that ended with `done`.
    ///
    /// # Errors
    /// [`Error::Diverged`] if it is not; the error of `done`; an error if the device is lost.
    pub async fn check(&mut self, rock: Option<&Rock>, done: Result<()>) -> Result<()> {
        let (device, queue) = (&self.device, &self.queue);
        let fault = self.observer.fault(device, queue, &self.lattice).await?;
        // A fault of the flow propagates to the blocks and causes their errors, so it comes first.
        if let Some(fault) = fault {
            return Err(self.diverged(rock, fault));
        }
        done?;
        self.check_suga().await
    }

    /// Checks that WALE does not raise the relaxation time above the stability bound of the published operator.
    async fn check_suga(&mut self) -> Result<()> {
        let setup = self.lattice.setup();
        if setup.collision != Collision::Suga || setup.wale.is_none() {
            return Ok(());
        }
        let tau = setup.tau();
        let (device, queue) = (&self.device, &self.queue);
        let viscosity = self
            .observer
            .derived(device, queue, &mut self.lattice, Derived::EddyViscosity)
            .await?;
        let largest = viscosity.into_iter().fold(0.0, f32::max);
        let effective = tau + 3.0 * f64::from(largest);
        let bound = 0.5 + SUGA_EXCESS.end();
        if effective <= bound {
            return Ok(());
        }
        Err(Error::scene(
            "numerics.collision",
            format!(
                "in step {} WALE lifts the relaxation time to {effective:.3}, and `suga` is unstable above \
                 {bound}; use collision = \"hermite\", or a time step of {:.2e} s",
                self.lattice.step(),
                self.units.time_step * (bound - 0.5) / (effective - 0.5)
            ),
        ))
    }

    /// Records the boundaries and the bricks with blocks.
    fn record_psm(&mut self, encoder: &mut wgpu::CommandEncoder) -> Result<()> {
        self.sample_in_step(encoder)?;
        if self.phases.is_some() {
            let mut pass = begin_pass(&mut self.phases, encoder, "boundaries");
            self.lattice.record_boundaries(&mut pass);
        }
        let mut pass = begin_pass(&mut self.phases, encoder, "bricks with blocks");
        self.lattice.record_psm(&mut pass);
        Ok(())
    }

    /// Records the other bricks.
    fn record_rest(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let mut pass = begin_pass(&mut self.phases, encoder, "bulk");
        self.lattice.record_rest(&mut pass);
    }

    /// Submits steps that end without an exchange.
    async fn submit(&mut self, mut encoder: wgpu::CommandEncoder) -> Result<()> {
        if let Some(phases) = &self.phases {
            phases.resolve(&mut encoder);
        }
        self.queue.submit([encoder.finish()]);
        match &mut self.phases {
            Some(phases) => phases.collect(&self.device, &self.queue).await,
            None => Ok(()),
        }
    }

    /// Runs a step that ends with an exchange. The bricks with blocks run first; the other bricks run while the loads on
    /// the blocks are read back, with `faces` also the loads on their faces.
    async fn exchange(
        &mut self,
        mut encoder: wgpu::CommandEncoder,
        interval: ExchangeInterval,
        faces: bool,
    ) -> Result<Option<Vec<FluidLoad>>> {
        let step = self.lattice.step() + 1;
        self.record_psm(&mut encoder)?;
        if let Some(coupling) = &mut self.coupling {
            coupling.record_loads(&self.device, (&mut encoder, &mut self.phases), step);
            if faces {
                coupling.record_faces(&self.device, (&mut encoder, &mut self.phases), step);
            }
        }
        self.queue.submit([encoder.finish()]);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        self.record_rest(&mut encoder);
        if let Some(phases) = &self.phases {
            phases.resolve(&mut encoder);
        }
        self.queue.submit([encoder.finish()]);
        let Some(coupling) = &mut self.coupling else {
            return Ok(None);
        };
        let start = self.phases.is_some().then(Instant::now);
        let moving = matches!(interval, ExchangeInterval::Awake { .. });
        coupling.read_loads(moving).await?;
        if let (Some(phases), Some(start)) = (&mut self.phases, start) {
            phases.add("readback wait", start.elapsed().as_secs_f64());
            phases.collect(&self.device, &self.queue).await?;
        }
        let loads = coupling.exchange();
        self.set_faces()?;
        self.control_flow().await?;
        Ok(Some(loads))
    }

    /// The faces whose values change at the present time, with the new values.
    fn changed_faces(&self) -> Result<Vec<(Face, lattice::Face)>> {
        let mut changed = Vec::new();
        for &face in &self.time_dependent_faces {
            let (axis, side) = (face.axis().index(), usize::from(face.is_max()));
            let old = &self.lattice.setup().faces[axis][side];
            let density = || face_density(&self.scene, &self.units, face, self.time());
            let new = match old {
                lattice::Face::Pressure { .. } => lattice::Face::Pressure {
                    density: density()?,
                },
                lattice::Face::Outflow { .. } => lattice::Face::Outflow {
                    density: density()?,
                },
                _ => {
                    let velocity = face_velocity(&self.scene, &self.units, face, self.time())?;
                    lattice::Face::Velocity(velocity)
                }
            };
            if *old != new {
                changed.push((face, new));
            }
        }
        Ok(changed)
    }

    /// Sets the faces to their values at the present time.
    ///
    /// # Errors
    /// The errors of face formulas.
    pub fn set_faces(&mut self) -> Result<()> {
        for (face, new) in self.changed_faces()? {
            let (axis, side) = (face.axis().index(), usize::from(face.is_max()));
            let (lattice, queue) = (&mut self.lattice, &self.queue);
            let set = match new {
                lattice::Face::Velocity(velocity) => {
                    lattice.set_face_velocity(queue, axis, side, velocity)
                }
                lattice::Face::Pressure { density } | lattice::Face::Outflow { density } => {
                    lattice.set_face_density(queue, axis, side, density)
                }
                _ => Ok(()),
            };
            set.map_err(|error| error.at_key(lattice_key))?;
        }
        Ok(())
    }

    /// The present state.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn state(&mut self) -> Result<LatticeState> {
        let coupling = match &mut self.coupling {
            Some(coupling) => Some(coupling.state().await?),
            None => None,
        };
        let sampling = self.sampling_state().await?;
        let (device, queue, lattice) = (&self.device, &self.queue, &mut self.lattice);
        Ok(LatticeState {
            cell: self.units.cell,
            sampling,
            flow_control: self.flow_control.as_ref().map(FlowControl::state),
            inside: self.observer.inside(device, queue, lattice).await?,
            populations: lattice.populations(device, queue).await?,
            coupling,
        })
    }

    /// Checks that a state fits.
    ///
    /// # Errors
    /// [`Error::Argument`] if it belongs to another grid or other blocks.
    pub fn check_state(&self, state: &LatticeState) -> Result<()> {
        if differ(state.cell, self.units.cell) {
            let cells = |cell: f64| format!("cells of {cell:e} m");
            return Err(other_scene(cells(state.cell), cells(self.units.cell)));
        }
        self.lattice.check_populations(&state.populations)?;
        state.inside.check(self.lattice.grid())?;
        if let (Some(sampling), Some(state)) = (&self.sampling, &state.sampling) {
            sampling.check(&self.lattice, state)?;
        }
        match (&self.coupling, &state.coupling) {
            (Some(coupling), Some(state)) => coupling.check(state),
            (None, None) => Ok(()),
            (Some(_), None) => Err(other_scene("a fluid without blocks", "blocks in a fluid")),
            (None, Some(_)) => Err(other_scene("blocks in a fluid", "a fluid without blocks")),
        }
    }

    /// Restores a state that [`LatticeFluid::check_state`] accepts.
    ///
    /// # Errors
    /// The errors of the lattice and of face formulas.
    pub fn restore(&mut self, state: &LatticeState) -> Result<()> {
        if let (Some(coupling), Some(state)) = (&mut self.coupling, &state.coupling) {
            coupling.restore(state);
        }
        let (device, queue) = (&self.device, &self.queue);
        self.lattice
            .set_populations(device, queue, &state.populations)?;
        self.observer
            .keep_inside(device, &self.lattice, &state.inside)?;
        if let Some(sampling) = &mut self.sampling {
            sampling.restore(queue, &mut self.lattice, state.sampling.as_ref())?;
        }
        self.restore_flow_control(state.flow_control)?;
        self.set_faces()
    }
}

impl Fluid for LatticeFluid {
    fn time(&self) -> f64 {
        self.lattice.step() as f64 * self.units.time_step
    }

    async fn advance(
        &mut self,
        poses: &[Pose],
        interval: ExchangeInterval,
        end: f64,
    ) -> Result<Option<Vec<FluidLoad>>> {
        let last = (end / self.units.time_step).round() as u64;
        // The lists of bricks and the fields of blocks are still those of the last step.
        self.sample_observed()?;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        if let Some(coupling) = &mut self.coupling {
            let (device, queue) = (&self.device, &self.queue);
            coupling
                .place(
                    device,
                    queue,
                    &mut self.lattice,
                    (&mut encoder, &mut self.phases),
                    poses,
                )
                .await?;
        }
        loop {
            let next = self.lattice.step() + 1;
            let exchanging = self
                .coupling
                .as_ref()
                .filter(|coupling| coupling.exchanges_at(interval, next, last));
            if let Some(coupling) = exchanging {
                let faces = coupling.needs_faces(interval, next, last);
                return self.exchange(encoder, interval, faces).await;
            }
            self.record_psm(&mut encoder)?;
            if let Some(coupling) = self
                .coupling
                .as_mut()
                .filter(|coupling| coupling.needs_loads(interval, next, last))
            {
                let phases = &mut self.phases;
                coupling.record_loads(&self.device, (&mut encoder, phases), next);
            }
            self.record_rest(&mut encoder);
            let coming = self.changed_faces();
            let goes_on = coming.as_ref().is_ok_and(|coming| coming.is_empty());
            let ends = self.lattice.step() == last || !goes_on;
            if ends || self.observed_sample_due() || self.control_due() {
                // The recorded steps count as done, even if the next step fails. Face values change only
                // between two submissions.
                self.submit(encoder).await?;
                self.set_faces()?;
                self.control_flow().await?;
                return Ok(None);
            }
        }
    }
}

/// The initial state in lattice units; cells of static solids are at rest.
fn start(scene: &Scene, units: &Units) -> Result<State> {
    let fields = scene.initial_fields()?;
    let excess = |p: &f32| (units.pressure_to_lattice((*p).into()) - 1.0) as f32;
    let speed = |u: &f32| units.velocity_to_lattice((*u).into()) as f32;
    Ok(State {
        excess: fields.pressure.iter().map(excess).collect(),
        velocity: fields
            .velocity
            .each_ref()
            .map(|u| u.iter().map(speed).collect()),
    })
}
