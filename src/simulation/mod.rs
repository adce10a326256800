//! A scene on a device: the loop that a user sees.

mod beside;
mod block_fields;
pub mod checkpoint;
mod countable;
mod diverged;
mod dry;
mod face_surface;
mod fields;
mod flow;
mod free_surface;
mod needs;
mod point_cloud;
mod pool;
pub mod probe;
mod sensors;
mod wall_units;
mod water_ledger;

pub use block_fields::{block_polyhedra, contact_cloud, voigt};
pub use dry::Dry;
pub use face_surface::face_surface;
pub use fields::Totals;
pub use free_surface::FreeSurface;
pub use needs::Needs;
pub use point_cloud::point_cloud;
pub use sensors::Reading;
pub use wall_units::{FirstCell, SUBLAYER, WallUnits};
pub use water_ledger::WaterLedger;

use self::countable::countable;
use crate::{
    Error, Result,
    coupling::{self, Coupled, Rock},
    error::told,
    lattice::{Collision, Derived, Lattice, Observer, State},
    scene::{
        Advice, Boundary, Face, SUGA_EXCESS, Scene,
        build::{block_setup, lattice_key, lattice_setup},
    },
    simulation::checkpoint::Checkpoint,
    units::Units,
};
use flow::Flow;

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
        advice.extend(scene.slips(units.time_step));
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
            let mut lattice =
                Lattice::new(device, setup).map_err(|error| error.at_key(lattice_key))?;
            let observer = Observer::new(device, &lattice)?;
            let coupled = match scene.has_blocks() {
                true => {
                    let blocks = block_setup(scene)?;
                    let scene = (scene, &units);
                    let made = Coupled::new(device, queue, &lattice, scene, blocks).await?;
                    countable(units.time_step, made.blocks())?;
                    Some(made)
                }
                false => None,
            };
            if let Some(coupled) = &coupled {
                advice.extend(coupled.advise(scene));
                coupled.set_interior_velocity(&scene.domain, &mut start);
            }
            lattice
                .start(device, queue, &start, true)
                .map_err(|error| error.at_key(lattice_key))?;
            Ok((lattice, observer, coupled))
        };
        let made = made.await;
        // What a buffer that is none is bound to is not valid either: memory is the cause.
        let [validity, memory] = [validity.pop(), memory.pop()];
        let refused = (validity.await, memory.await);
        let (lattice, observer, coupled) = made?;
        if let Some(error) = refused.1.or(refused.0) {
            let bytes: u64 = lattice.bytes().iter().map(|(_, bytes)| bytes).sum();
            return Err(Error::Device(format!(
                "it does not hold {} cells, {bytes} bytes in its buffers ({}); use a larger cell or 16-bit storage",
                lattice.grid().cell_count(),
                told(&error)
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
        let end = (self.step() + steps) as f64 * self.units.time_step;
        let (mut flow, rock) = self.flow_and_rock();
        let done = match rock {
            Some(rock) => coupling::run(&mut flow, rock, end).await,
            None => flow.run(end).await,
        };
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

    /// The fluid, and the blocks in it.
    fn flow_and_rock(&mut self) -> (Flow<'_>, Option<&mut Rock>) {
        let (rock, coupling) = self
            .coupled
            .as_mut()
            .map(Coupled::rock_and_coupling)
            .unzip();
        let flow = Flow {
            device: &self.device,
            queue: &self.queue,
            scene: &self.scene,
            units: &self.units,
            lattice: &mut self.lattice,
            changing: &self.changing,
            coupling,
        };
        (flow, rock)
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
        let (device, queue) = (&self.device, &self.queue);
        let lattice = &mut self.lattice;
        Ok(Checkpoint {
            inside: self.observer.inside(device, queue, lattice).await?,
            time_step: self.units.time_step,
            cell: self.units.cell,
            populations: self.lattice.populations(device, queue).await?,
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
            return Err(Error::argument(
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
        checkpoint.inside.check(self.lattice.grid())?;
        match (&mut self.coupled, &checkpoint.blocks) {
            (Some(coupled), Some(state)) => coupled.restore(state)?,
            (None, None) => {}
            (coupled, _) => {
                let has = |some: bool| if some { "has blocks" } else { "has none" };
                return Err(Error::argument(
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
        self.observer
            .keep_inside(&self.device, &self.lattice, &checkpoint.inside)?;
        self.flow_and_rock().0.set_faces()
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
