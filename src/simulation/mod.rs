//! A scene on a device: the loop that a user sees.

mod beside;
mod block_fields;
mod block_setup;
mod diverged;
mod dry;
mod face_surface;
mod fields;
mod free_surface;
mod lattice_setup;
mod needs;
mod wall_units;

pub use block_fields::{block_polyhedra, contact_cloud, voigt};
pub use block_setup::{BlockSetup, LeftOut, block_setup};
pub(crate) use block_setup::{rotation, shape};
pub use dry::Dry;
pub(crate) use dry::{begin, finder};
pub use face_surface::face_surface;
pub use fields::Totals;
pub use free_surface::FreeSurface;
pub use lattice_setup::{face_velocity, lattice_setup};
pub use needs::Needs;
pub use wall_units::{FirstCell, SUBLAYER, WallUnits};

use crate::{
    Error, Result,
    checkpoint::Checkpoint,
    coupling::Coupled,
    lattice::{self, Collision, Derived, Lattice, Observer, State},
    scene::{Advice, Boundary, Face, SUGA_EXCESS, Scene},
    units::Units,
};

/// A scene that runs.
///
/// Nothing here blocks: what reads from the device is a future, and somebody must poll the device
/// meanwhile (`wgpu::Device::poll`).
#[derive(Debug)]
pub struct Simulation {
    device: wgpu::Device,
    queue: wgpu::Queue,
    scene: Scene,
    units: Units,
    advice: Advice,
    lattice: Lattice,
    observer: Observer,
    /// Velocity faces whose formulas contain the time.
    changing: Vec<Face>,
    /// The blocks in the fluid.
    coupled: Option<Coupled>,
}

impl Simulation {
    /// Compiles the kernels of a scene and sets its initial state.
    ///
    /// # Errors
    /// What the scene lacks, or what the device cannot hold.
    pub async fn new(device: &wgpu::Device, queue: &wgpu::Queue, scene: &Scene) -> Result<Self> {
        let units = Units::of(scene)?;
        let mut advice = scene.advise(&units)?;
        let software = device.adapter_info().device_type == wgpu::DeviceType::Cpu;
        let setup = lattice_setup(scene, &units, software.then(|| device.features()))?;
        let mut start = start(scene, &units)?;
        let changing = |(face, boundary): (Face, &Boundary)| match boundary {
            Boundary::Velocity { velocity } if velocity.iter().any(|f| f.uses_time()) => Some(face),
            _ => None,
        };
        let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let validity = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let made = async {
            let mut lattice = Lattice::new(device, setup)?;
            let observer = Observer::new(device, &lattice)?;
            let coupled = match scene.has_blocks() {
                true => {
                    let blocks = block_setup(scene)?;
                    let scene = (scene, &units);
                    Some(Coupled::new(device, queue, &lattice, scene, blocks).await?)
                }
                false => None,
            };
            if let Some(coupled) = &coupled {
                advice.extend(coupled.advise(scene));
                coupled.fill(&scene.domain, &mut start);
            }
            lattice.start(device, queue, &start, true)?;
            Ok((lattice, observer, coupled))
        };
        let made = made.await;
        let refused = validity.pop().await.or(memory.pop().await);
        let (lattice, observer, coupled) = made?;
        if let Some(error) = refused {
            return Err(Error::Device(format!(
                "it does not hold {} cells ({error}); use a larger cell or 16-bit storage",
                lattice.grid().cell_count()
            )));
        }
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            coupled,
            scene: scene.clone(),
            units,
            advice,
            lattice,
            observer,
            changing: scene.boundaries.iter().filter_map(changing).collect(),
        })
    }

    /// Takes `steps` steps and looks at the guard.
    ///
    /// # Errors
    /// [`Error::Diverged`] if the flow left the range of the method; those of the blocks; a lost device. If the
    /// blocks cannot move, they are where they were at the last exchange, and the fluid is at the end of the
    /// step; a checkpoint leads back to a state from which all can go on.
    pub async fn advance(&mut self, steps: u64) -> Result<()> {
        let last = self.step() + steps;
        let mut done = Ok(());
        while self.step() < last && done.is_ok() {
            done = self.stretch(last).await;
        }
        let fault = self
            .observer
            .fault(&self.device, &self.queue, &self.lattice)
            .await?;
        // What the flow did wrong reaches the blocks: it is the cause of what they complain of.
        if let Some(fault) = fault {
            return Err(self.diverged(fault));
        }
        done?;
        self.check_suga().await
    }

    /// Steps in one go until `last`, or until the host has something to do: blocks to move, or a velocity
    /// that changes to write.
    async fn stretch(&mut self, last: u64) -> Result<()> {
        let (device, queue) = (self.device.clone(), self.queue.clone());
        let mut encoder = device.create_command_encoder(&Default::default());
        if let Some(coupled) = &mut self.coupled {
            let lattice = &mut self.lattice;
            coupled
                .place(&device, &queue, lattice, &mut encoder)
                .await?;
        }
        loop {
            let next = self.step() + 1;
            let coupled = self.coupled.as_ref();
            if coupled.is_some_and(|coupled| coupled.meets(next, last)) {
                self.exchange(encoder).await?;
                let coming = self.changed_faces()?;
                return self.set_faces(coming);
            }
            self.lattice
                .record_saturated(&mut encoder.begin_compute_pass(&Default::default()));
            if let Some(coupled) = self.coupled.as_mut().filter(|c| c.wants(next, last)) {
                coupled.record_loads(&device, &mut encoder, next);
            }
            self.lattice
                .record_rest(&mut encoder.begin_compute_pass(&Default::default()));
            let coming = self.changed_faces();
            let goes_on = coming.as_ref().is_ok_and(|coming| coming.is_empty());
            if self.step() == last || !goes_on {
                // What is recorded counts as done, whatever the next step lacks.
                queue.submit([encoder.finish()]);
                // A velocity that changes is written between two submissions.
                return self.set_faces(coming?);
            }
        }
    }

    /// The last step of a stretch, at whose end the blocks move, or are asked what they feel: the fluid around
    /// them runs first, and the rest of it while their loads are read.
    async fn exchange(&mut self, mut encoder: wgpu::CommandEncoder) -> Result<()> {
        let (device, queue) = (&self.device, &self.queue);
        let Some(coupled) = &mut self.coupled else {
            return Ok(());
        };
        self.lattice
            .record_saturated(&mut encoder.begin_compute_pass(&Default::default()));
        coupled.record_loads(device, &mut encoder, self.lattice.step() + 1);
        coupled.record_faces(device, &mut encoder, self.lattice.step() + 1);
        queue.submit([encoder.finish()]);
        let mut encoder = device.create_command_encoder(&Default::default());
        self.lattice
            .record_rest(&mut encoder.begin_compute_pass(&Default::default()));
        queue.submit([encoder.finish()]);
        coupled.read_loads().await?;
        coupled.exchange();
        if !coupled.moves() {
            return Ok(());
        }
        let until = self.lattice.step() as f64 * self.units.time_step;
        coupled.advance(until).await
    }

    /// The published operator is unstable where WALE lifts the relaxation time over its bound.
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
                self.step(),
                self.units.time_step * (bound - 0.5) / (effective - 0.5)
            ),
        ))
    }

    /// The velocity faces whose values at the present time are not those that they have.
    fn changed_faces(&self) -> Result<Vec<(Face, Vec<[f32; 3]>)>> {
        let mut changed = Vec::new();
        for &face in &self.changing {
            let velocity = face_velocity(&self.scene, &self.units, face, self.time())?;
            let (axis, side) = (face.axis().index(), usize::from(face.is_max()));
            match &self.lattice.setup().faces[axis][side] {
                lattice::Face::Velocity(old) if *old == velocity => {}
                _ => changed.push((face, velocity)),
            }
        }
        Ok(changed)
    }

    fn set_faces(&mut self, faces: Vec<(Face, Vec<[f32; 3]>)>) -> Result<()> {
        for (face, velocity) in faces {
            let (axis, side) = (face.axis().index(), usize::from(face.is_max()));
            self.lattice
                .set_face_velocity(&self.queue, axis, side, velocity)?;
        }
        Ok(())
    }

    /// Steps done.
    pub fn step(&self) -> u64 {
        self.lattice.step()
    }

    /// Simulated time, s.
    pub fn time(&self) -> f64 {
        self.step() as f64 * self.units.time_step
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Its units.
    pub fn units(&self) -> &Units {
        &self.units
    }

    /// What may disappoint in it.
    pub fn advice(&self) -> &Advice {
        &self.advice
    }

    /// The fluid.
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// The blocks in it, if there are any.
    pub fn coupled(&self) -> Option<&Coupled> {
        self.coupled.as_ref()
    }

    /// Which cells are solid, x fastest; empty where there are none.
    pub fn solid(&self) -> &[bool] {
        &self.lattice.setup().solid
    }

    /// The present state, for a later [`Simulation::restore`].
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn checkpoint(&mut self) -> Result<Checkpoint> {
        let blocks = match &mut self.coupled {
            Some(coupled) => Some(coupled.state().await?),
            None => None,
        };
        Ok(Checkpoint {
            time_step: self.units.time_step,
            cell: self.units.cell,
            populations: self.lattice.populations(&self.device, &self.queue).await?,
            blocks,
        })
    }

    /// Goes on from a checkpoint of the same scene.
    ///
    /// # Errors
    /// If it is of another grid or time step.
    pub fn restore(&mut self, checkpoint: &Checkpoint) -> Result<()> {
        let same = |a: f64, b: f64| (a - b).abs() <= 1e-12 * b;
        let Units {
            cell, time_step, ..
        } = self.units;
        if !same(checkpoint.time_step, time_step) || !same(checkpoint.cell, cell) {
            return Err(Error::scene(
                "restart",
                format!(
                    "the checkpoint has a time step of {:e} s and cells of {:e} m, the scene {:e} s \
                     and {:e} m; restart with the scene that wrote it",
                    checkpoint.time_step, checkpoint.cell, time_step, cell
                ),
            ));
        }
        // All is looked at before anything is changed.
        self.lattice.check_populations(&checkpoint.populations)?;
        match (&mut self.coupled, &checkpoint.blocks) {
            (Some(coupled), Some(state)) => coupled.restore(state)?,
            (None, None) => {}
            (coupled, _) => {
                let has = |some: bool| if some { "has blocks" } else { "has none" };
                return Err(Error::scene(
                    "restart",
                    format!(
                        "the checkpoint {} and the scene {}; restart with the scene that wrote it",
                        has(checkpoint.blocks.is_some()),
                        has(coupled.is_some())
                    ),
                ));
            }
        }
        self.lattice
            .set_populations(&self.device, &self.queue, &checkpoint.populations)?;
        let changed = self.changed_faces()?;
        self.set_faces(changed)
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
