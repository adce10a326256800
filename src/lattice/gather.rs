//! Readback of the values of listed cells.

use super::{Lattice, buffers};
use crate::{
    Error, Result,
    gpu::{
        buffers::zeroed,
        kernel::{Kernel, submit_pass},
        readback::Readback,
    },
};
use std::sync::Arc;

/// Gathers the values of listed cells on the device before the readback.
#[derive(Debug)]
pub(super) struct Gather(Arc<Kernel>);

impl Gather {
    pub(super) fn new(device: &wgpu::Device, lattice: &Lattice) -> Result<Self> {
        let program = lattice.cell_program("gather");
        Ok(Self(lattice.cell_kernel(
            device,
            &program,
            "gather",
            &[],
        )?))
    }

    /// Reads `field` on `cells`, which are indices into it.
    pub(super) async fn read(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        readback: &mut Readback,
        field: &wgpu::Buffer,
        cells: &[u32],
    ) -> Result<Vec<f32>> {
        if cells.is_empty() {
            return Ok(Vec::new());
        }
        let count = field.size() / 4;
        if let Some(bad) = cells.iter().find(|&&cell| u64::from(cell) >= count) {
            let message = format!("there is no cell {bad}, only {count}");
            return Err(Error::argument("cells", message));
        }
        let list = buffers::storage(device, "listed cells", bytemuck::cast_slice(cells));
        let out = zeroed(device, "gathered", 4 * cells.len() as u64);
        let buffers = [
            ("gather_from", field),
            ("listed", &list),
            ("gathered", &out),
        ];
        let bind = self.0.bind(device, &buffers)?;
        let groups = (cells.len() as u32).div_ceil(64);
        submit_pass(device, queue, |pass| self.0.record(pass, &bind, groups));
        readback.read(device, queue, &out, cells.len()).await
    }
}
