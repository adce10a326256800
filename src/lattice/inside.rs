//! Velocities in cells with solid, for restarts.

use super::{Grid, Lattice, Observer, buffers::storage, observe::VELOCITY_OUT};
use crate::{Error, Result, gpu::kernel::Kernel};
use std::sync::Arc;

/// Velocities in cells with solid at the end of a step: they depend on the action of the solid in that step, which the populations do not contain.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct Inside {
    /// Indices of the cells, x fastest, ascending: those whose velocity differs from that of the populations alone.
    #[cfg_attr(feature = "checkpoint", serde(with = "crate::gpu::plain_bytes"))]
    pub cells: Vec<u32>,
    /// Their velocities, component by component, lattice units.
    #[cfg_attr(feature = "checkpoint", serde(with = "crate::gpu::plain_bytes"))]
    pub velocity: Vec<f32>,
}

impl Inside {
    /// Checks whether [`Observer::keep_inside`] accepts them.
    ///
    /// # Errors
    /// If they belong to another grid.
    pub fn check(&self, grid: &Grid) -> Result<()> {
        let count = grid.cell_count();
        let outside = self.cells.iter().any(|n| *n as usize >= count);
        match outside || self.velocity.len() != 3 * self.cells.len() {
            true => {
                let message = "the saved velocities in cells with solid are of another grid";
                Err(Error::argument("restart", message))
            }
            false => Ok(()),
        }
    }
}

/// The velocities of a step, valid until the lattice advances.
#[derive(Debug)]
pub(super) struct Kept {
    step: u64,
    /// `None` without cells.
    dispatch: Option<(Arc<Kernel>, wgpu::BindGroup, u32)>,
}

impl Kept {
    /// Replaces the velocities of the populations, if they belong to this step.
    pub fn record(&self, step: u64, pass: &mut wgpu::ComputePass<'_>) -> bool {
        if let Some((kernel, bind, groups)) = self.dispatch.as_ref().filter(|_| self.step == step) {
            kernel.record(pass, bind, *groups);
        }
        self.step == step
    }
}

impl Observer {
    /// Reads the velocities in cells with solid, for a later [`Observer::keep_inside`].
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn inside(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lattice: &mut Lattice,
    ) -> Result<Inside> {
        if lattice.setup().solid_operator.is_none() {
            return Ok(Inside::default());
        }
        let shown = self.state(device, queue, lattice).await?.velocity;
        let own = self.velocity_of_populations(device, queue, lattice).await?;
        let differs = |n: &u32| {
            let n = *n as usize;
            let pairs = shown.iter().zip(&own);
            pairs
                .into_iter()
                .any(|(a, b)| a[n].to_bits() != b[n].to_bits())
        };
        let cells: Vec<u32> = (0..lattice.grid().cell_count() as u32)
            .filter(differs)
            .collect();
        let of = |values: &Vec<f32>| {
            cells
                .iter()
                .map(|n| values[*n as usize])
                .collect::<Vec<_>>()
        };
        Ok(Inside {
            velocity: shown.iter().flat_map(of).collect(),
            cells,
        })
    }

    /// Uses these velocities in their cells until the lattice, whose populations must be of the same step, advances.
    ///
    /// # Errors
    /// [`Error::Argument`] if they belong to another grid.
    pub fn keep_inside(
        &mut self,
        device: &wgpu::Device,
        lattice: &Lattice,
        inside: &Inside,
    ) -> Result<()> {
        inside.check(lattice.grid())?;
        let dispatch = match inside.cells.len() as u32 {
            0 => None,
            count => {
                let program = lattice.cell_program("velocity_restored");
                let kernel = lattice.cell_kernel(device, &program, "velocity_restored", &[])?;
                let cells = storage(device, "kept cells", bytemuck::cast_slice(&inside.cells));
                let velocity = bytemuck::cast_slice(&inside.velocity);
                let velocity = storage(device, "kept velocity", velocity);
                let mut buffers =
                    vec![("restored_cells", &cells), ("restored_velocity", &velocity)];
                buffers.extend(VELOCITY_OUT.into_iter().zip(self.velocity()));
                let bind = kernel.bind(device, &buffers)?;
                Some((kernel, bind, count.div_ceil(64)))
            }
        };
        self.holds = None;
        self.kept = Some(Kept {
            step: lattice.step(),
            dispatch,
        });
        Ok(())
    }
}
