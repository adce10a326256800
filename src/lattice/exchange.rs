//! Populations in canonical order, for checkpoints.

use super::{
    CellPass, Lattice,
    buffers::{self, GUARD_START},
    cell_kernels::uniform,
};
use crate::{
    Error, Result,
    gpu::{
        buffers::zeroed,
        kernel::{Kernel, submit_pass},
        readback::Readback,
    },
};
use std::sync::Arc;

/// The full state of a fluid: no parity, no padding, no lanes, shifted by the weights, so that it
/// restarts under any storage, lane or binding count.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct Populations {
    /// Number of steps done.
    pub step: u64,
    /// Number of cells along each axis.
    pub cells: [u32; 3],
    /// f_q − w_q of each cell, direction by direction, x fastest.
    #[cfg_attr(feature = "checkpoint", serde(with = "crate::gpu::plain_bytes"))]
    pub values: Vec<f32>,
    /// Velocity from which the eddy viscosity of the coming step follows, component by component; empty without.
    #[cfg_attr(feature = "checkpoint", serde(with = "crate::gpu::plain_bytes"))]
    pub velocity: Vec<f32>,
    /// Eddy viscosity of each cell in the coming step, if it is that of the last one; otherwise empty.
    #[cfg_attr(feature = "checkpoint", serde(with = "crate::gpu::plain_bytes"))]
    pub eddy_viscosity: Vec<f32>,
    /// Least eddy viscosity of each cell in the coming step, by a wall model where blocks are in the fluid; otherwise empty.
    #[cfg_attr(feature = "checkpoint", serde(with = "crate::gpu::plain_bytes"))]
    pub near_wall: Vec<f32>,
    /// Data of the outflow faces for the next step, face by face.
    #[cfg_attr(feature = "checkpoint", serde(with = "crate::gpu::plain_bytes"))]
    pub outflow_state: Vec<f32>,
    /// Displacement of the mean flow through each face with synthetic turbulence, 2⁻¹⁶ cell; if empty, faces start anew.
    pub travelled: Vec<u32>,
}

impl Lattice {
    /// Reads the state between two steps.
    ///
    /// # Errors
    /// If the device is lost or cannot hold one more direction.
    pub async fn populations(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
    ) -> Result<Populations> {
        let cells = self.grid.cell_count();
        let buffer = zeroed(device, "canonical", 4 * cells as u64);
        let mut readback = Readback::default();
        let mut values = Vec::with_capacity(27 * cells);
        let out = self.exchange(device, "take_out", 0)?;
        for q in 0..27u32 {
            let direction = buffers::storage(device, "direction", bytemuck::bytes_of(&q));
            submit_pass(device, queue, |pass| {
                self.close(pass);
                self.record_exchange(device, &out, pass, &direction, &buffer)
            })?;
            values.extend(readback.read::<f32>(device, queue, &buffer, cells).await?);
        }
        let mut velocity = Vec::new();
        if let Some(before) = self.buffers.velocity_before(self.parity() == 1) {
            for buffer in before {
                let count = (buffer.size() / 4) as usize;
                let planes: Vec<f32> = readback.read(device, queue, buffer, count).await?;
                for plane in planes.chunks(self.grid.scalar_count() as usize) {
                    let of = |cell| plane[self.grid.scalar_of(cell) as usize];
                    velocity.extend(self.grid.domain().map(of));
                }
            }
        }
        let [mut eddy_viscosity, mut near_wall] = [const { Vec::new() }; 2];
        let scalars = [
            (self.kept_viscosity(self.step), &mut eddy_viscosity),
            (self.near_wall_of_blocks(), &mut near_wall),
        ];
        for (buffer, values) in scalars {
            let Some(buffer) = buffer else { continue };
            let count = (buffer.size() / 4) as usize;
            let plane: Vec<f32> = readback.read(device, queue, buffer, count).await?;
            let of = |cell| plane[self.grid.scalar_of(cell) as usize];
            values.extend(self.grid.domain().map(of));
        }
        let mut outflow_state = Vec::new();
        let outflow = &self.geometry.outflow;
        if !outflow.is_empty() {
            let buffer = &self.buffers.open.outflow_state;
            let own: Vec<f32> = readback
                .read(device, queue, buffer, 27 * outflow.len())
                .await?;
            for place in self.geometry.stages.canonical(outflow) {
                outflow_state.extend_from_slice(&own[27 * place..27 * (place + 1)]);
            }
        }
        Ok(Populations {
            outflow_state,
            step: self.step,
            cells: self.grid.cells,
            values,
            velocity,
            eddy_viscosity,
            near_wall,
            travelled: self.travelled(device, queue).await?,
        })
    }

    /// Checks whether [`Lattice::set_populations`] accepts a state.
    ///
    /// # Errors
    /// If it belongs to another grid, or lacks data for the eddy viscosity or the faces.
    pub fn check_populations(&self, state: &Populations) -> Result<()> {
        let cells = self.grid.cell_count();
        let wrong = |message: String| Err(Error::argument("restart", message));
        if state.cells != self.grid.cells || state.values.len() != 27 * cells {
            return wrong(format!(
                "the saved grid has {:?} cells, this scene {:?}",
                state.cells, self.grid.cells
            ));
        }
        if !self.buffers.velocity.is_empty() && state.velocity.len() != 3 * cells {
            return wrong("the saved state has no velocity, which the eddy viscosity needs".into());
        }
        if self.kept_viscosity(state.step).is_some() && state.eddy_viscosity.len() != cells {
            let message = "the saved state has no eddy viscosity, which an odd step needs; continue with `numerics.wale_interval` = 1";
            return wrong(message.into());
        }
        if state.outflow_state.len() != 27 * self.geometry.outflow.len() {
            return wrong("the saved state has other outflow faces".into());
        }
        Ok(())
    }

    /// Continues from a state; the same setup on the same device gives the same bits.
    ///
    /// # Errors
    /// If the state belongs to another grid, or lacks data for the eddy viscosity.
    pub fn set_populations(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        state: &Populations,
    ) -> Result<()> {
        self.check_populations(state)?;
        let cells = self.grid.cell_count();
        self.step = state.step;
        self.closed = true;
        self.revision += 1;
        self.write_mean_velocities(queue);
        self.set_travelled(queue, &state.travelled);
        if let Some(guard) = &self.buffers.guard {
            let [_, _, even_cell, odd_cell] = GUARD_START;
            let done = state.step as u32;
            queue.write_buffer(
                guard,
                0,
                bytemuck::cast_slice(&[done, done, even_cell, odd_cell]),
            );
        }
        if let [x, y, z] = state.velocity.chunks(cells.max(1)).collect::<Vec<_>>()[..] {
            self.set_velocity_before(queue, &[x.to_vec(), y.to_vec(), z.to_vec()]);
        }
        let write = |buffer: &wgpu::Buffer, values: &[f32]| {
            let mut plane = vec![0f32; (buffer.size() / 4) as usize];
            for (cell, value) in self.grid.domain().zip(values) {
                plane[self.grid.scalar_of(cell) as usize] = *value;
            }
            queue.write_buffer(buffer, 0, bytemuck::cast_slice(&plane));
        };
        if let Some(buffer) = self.kept_viscosity(state.step) {
            write(buffer, &state.eddy_viscosity);
        }
        match (
            &self.buffers.near_wall_viscosity,
            state.near_wall.len() == cells,
        ) {
            (Some(buffer), true) => {
                write(buffer, &state.near_wall);
                self.set_near_wall(device, queue, true)?;
            }
            // Without blocks it follows from the velocity.
            (Some(_), false) => self.set_near_wall(device, queue, false)?,
            (None, _) => {}
        }
        let into: Vec<_> = self
            .halves()
            .map(|half| self.exchange(device, "bring_in", half))
            .collect::<Result<_>>()?;
        for (q, values) in (0..27u32).zip(state.values.chunks(cells)) {
            let direction = buffers::storage(device, "direction", bytemuck::bytes_of(&q));
            let buffer = buffers::storage(device, "canonical", bytemuck::cast_slice(values));
            submit_pass(device, queue, |pass| {
                into.iter().try_for_each(|exchange| {
                    self.record_exchange(device, exchange, pass, &direction, &buffer)
                })
            })?;
        }
        let mut outflow_state = vec![0.0; state.outflow_state.len()];
        let places = self.geometry.stages.canonical(&self.geometry.outflow);
        for (place, of_cell) in places.into_iter().zip(state.outflow_state.chunks(27)) {
            outflow_state[27 * place..27 * (place + 1)].copy_from_slice(of_cell);
        }
        let buffer = &self.buffers.open.outflow_state;
        queue.write_buffer(buffer, 0, bytemuck::cast_slice(&outflow_state));
        Ok(())
    }

    /// The eddy viscosity that the coming step takes from the last one, after so many steps.
    fn kept_viscosity(&self, steps: u64) -> Option<&wgpu::Buffer> {
        let kept = self.buffers.eddy_viscosity.as_ref();
        kept.filter(|_| steps % 2 == 1)
    }

    /// The least eddy viscosity by a wall model where blocks are in the fluid.
    fn near_wall_of_blocks(&self) -> Option<&wgpu::Buffer> {
        let near_wall = self.buffers.near_wall_viscosity.as_ref();
        near_wall.filter(|_| self.setup.solid_operator.is_some())
    }

    fn exchange(&self, device: &wgpu::Device, entry: &'static str, half: u32) -> Result<Exchange> {
        let odd = self.parity() as u32;
        let pass = CellPass {
            odd,
            half,
            ..CellPass::default()
        };
        Ok(Exchange {
            kernel: self.cell_kernel(device, &self.cell_program("exchange"), entry, &[])?,
            pass: uniform(device, "cell pass", &pass),
        })
    }

    fn record_exchange(
        &self,
        device: &wgpu::Device,
        Exchange {
            kernel,
            pass: cell_pass,
        }: &Exchange,
        pass: &mut wgpu::ComputePass<'_>,
        direction: &wgpu::Buffer,
        canonical: &wgpu::Buffer,
    ) -> Result<()> {
        let mut buffers = vec![
            ("direction", direction),
            ("canonical", canonical),
            ("cell_pass", cell_pass),
        ];
        buffers.extend(self.buffers.named(self.parity() == 1));
        let bind = kernel.bind(device, &buffers)?;
        kernel.record(pass, &bind, (self.grid.cell_count() as u32).div_ceil(64));
        Ok(())
    }
}

/// A kernel that copies one direction, for one half of the words.
struct Exchange {
    kernel: Arc<Kernel>,
    pass: wgpu::Buffer,
}
