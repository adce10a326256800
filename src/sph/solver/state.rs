//! The state of the particle solver: reading it, and restarting from it.

use super::{
    super::{CellGrid, Clock, Counts, Particle, Setup, Water, layout::sort_escaped},
    SphSolver,
};
use crate::{Error, Result};
use glam::{DMat3, DVec3};

/// Work on the water since the start, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct ExternalWork {
    /// Work of moving bodies with loads: minus the load on them along their motion in the steps of the water.
    pub bodies: f64,
    /// Work of the penalty force of fixed bodies.
    pub penalty: f64,
    /// Work of boundary particles beyond the work of their walls and bodies. Boundary particles have pressures and no
    /// state of their own, so they supply the energy that a fluid in their place would lose. Most of it comes from
    /// corners, where the boundary particles of a fixed wall act on water near a moving body.
    pub boundary: f64,
    /// Work of gravity over the length of the domain for each particle that crossed a periodic boundary.
    pub gravity: f64,
}

/// State of the solver in a checkpoint, without the particles.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct SphState {
    /// Upper bound on the length of the next step, in device units.
    pub step_limit: f32,
    /// Particles that have left the domain.
    pub escaped: u32,
    /// Steps since the start.
    pub steps: u64,
    /// Length of the last exchange, s.
    pub last_duration: f64,
    /// Velocity (m/s) and Ḟ (1/s) of each body at the start of the last exchange.
    pub previous_rates: Vec<(DVec3, DMat3)>,
    /// Work on the water since the start.
    pub work: ExternalWork,
}

impl SphSolver {
    /// The present state of the water.
    ///
    /// # Errors
    /// [`Error::DeviceLost`].
    pub async fn water(&mut self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Water> {
        let particles = self.particles(device, queue).await?;
        Ok(Water::of(&self.setup, &self.grid, &particles))
    }

    /// The particles in the units and the order of the device; escaped particles are sorted by id.
    ///
    /// # Errors
    /// [`Error::DeviceLost`].
    pub async fn particles(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
    ) -> Result<Vec<Particle>> {
        let count = self.counts.fluid as usize;
        let buffer = &self.kernels.fluid.unsorted;
        let mut particles = self.readback.read(device, queue, buffer, count).await?;
        sort_escaped(&mut particles);
        Ok(particles)
    }

    /// The state for [`SphSolver::restore`], without the particles.
    pub fn state(&self) -> SphState {
        SphState {
            step_limit: self.clock.step_limit,
            escaped: self.clock.escaped,
            steps: self.steps,
            last_duration: self.history.last_duration,
            previous_rates: self.history.previous_rates.clone(),
            work: self.work,
        }
    }

    /// Checks that the number of particles matches this solver.
    ///
    /// # Errors
    /// [`Error::Argument`] if not.
    pub fn check(&self, particles: &[Particle]) -> Result<()> {
        if particles.len() == self.counts.fluid as usize {
            return Ok(());
        }
        Err(Error::argument(
            "restart",
            format!(
                "the checkpoint has {} particles and the scene {}; restart with the scene that wrote it",
                particles.len(),
                self.counts.fluid
            ),
        ))
    }

    /// Restores a state bit-identically.
    ///
    /// # Errors
    /// [`Error::Argument`] if the number of particles differs.
    pub fn restore(
        &mut self,
        queue: &wgpu::Queue,
        particles: &[Particle],
        state: &SphState,
    ) -> Result<()> {
        self.check(particles)?;
        let bytes = bytemuck::cast_slice(particles);
        queue.write_buffer(&self.kernels.fluid.unsorted, 0, bytes);
        self.clock = Clock {
            step_limit: state.step_limit,
            escaped: state.escaped,
            // The next sort leaves the escaped particles out of the cells.
            escaped_at_sort: state.escaped,
            ..Clock::default()
        };
        self.steps = state.steps;
        self.history = self
            .history
            .restored(&state.previous_rates, state.last_duration);
        self.work = state.work;
        self.boundary_placed = false;
        self.force_sort = true;
        Ok(())
    }

    /// Work on the water in the exchanges of [`SphSolver::advance`] since the start.
    pub fn work(&self) -> ExternalWork {
        self.work
    }

    /// The [`Particle`]s on the device, in unspecified order; escaped particles have a negative first coordinate.
    pub fn buffer(&self) -> &wgpu::Buffer {
        &self.kernels.fluid.unsorted
    }

    /// The [`Clock`] on the device.
    pub fn clock(&self) -> &wgpu::Buffer {
        &self.kernels.clock
    }

    /// The setup.
    pub fn setup(&self) -> &Setup {
        &self.setup
    }

    /// Cell grid and units of the device.
    pub fn grid(&self) -> &CellGrid {
        &self.grid
    }

    /// Numbers of particles and bodies.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Particles that have left the domain.
    pub fn escaped(&self) -> u32 {
        self.clock.escaped
    }

    /// Largest speed of the water at the end of any step since the start or the restart, m/s.
    pub fn max_speed(&self) -> f64 {
        f64::from(self.clock.max_speed) * self.grid.sound_speed()
    }

    /// Steps since the start.
    pub fn steps(&self) -> u64 {
        self.steps
    }
}
