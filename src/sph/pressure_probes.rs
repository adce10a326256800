//! Probes of the pressure in the water and on walls.

use super::{kernels::FEWER_PARTICLES, neighbour_lists::Buffers};
use crate::{
    Result,
    gpu::{
        bins::{WORKGROUP, at_most, storage},
        kernel::Kernel,
    },
};

/// The kernel `pressure_probes` with its buffers, which grow with the number of probes.
#[derive(Debug)]
pub(super) struct PressureProbes {
    kernel: Kernel,
    count: u32,
    memory: Option<Memory>,
}

#[derive(Debug)]
struct Memory {
    /// Probes that fit.
    capacity: u32,
    probes: wgpu::Buffer,
    pressures: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
}

impl PressureProbes {
    /// The kernel without probes.
    pub fn new(kernel: Kernel) -> Self {
        Self {
            kernel,
            count: 0,
            memory: None,
        }
    }

    /// Sets the probes: position in quanta, and the weight of a wall probe (see the kernel).
    pub fn set(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        probes: &[[i32; 4]],
        others: &Buffers<'_>,
    ) -> Result<()> {
        at_most(
            device,
            "pressure probes",
            16 * probes.len() as u64,
            FEWER_PARTICLES,
        )?;
        self.count = probes.len() as u32;
        let capacity = self.memory.as_ref().map_or(0, |memory| memory.capacity);
        if self.count > capacity {
            let limits = device.limits();
            let most = limits
                .max_storage_buffer_binding_size
                .min(limits.max_buffer_size)
                / 16;
            let capacity = (2 * u64::from(self.count)).min(most);
            let buffer = storage(device, "pressure probes", 16 * capacity);
            let pressures = storage(device, "probe pressures", 4 * capacity);
            let own = [("probes", &buffer), ("pressures", &pressures)];
            self.memory = Some(Memory {
                capacity: capacity as u32,
                bind_group: self.kernel.bind(device, &[&own, others].concat())?,
                probes: buffer,
                pressures,
            });
        }
        if let Some(memory) = &self.memory {
            queue.write_buffer(&memory.probes, 0, bytemuck::cast_slice(probes));
        }
        Ok(())
    }

    /// Sets the sums to zero.
    pub fn reset(&self, queue: &wgpu::Queue) {
        if let Some(memory) = &self.memory {
            queue.write_buffer(&memory.pressures, 0, &vec![0; 4 * memory.capacity as usize]);
        }
    }

    /// Records a step.
    pub fn record(&self, pass: &mut wgpu::ComputePass<'_>) {
        if let (Some(memory), 1..) = (&self.memory, self.count) {
            let groups = self.count.div_ceil(WORKGROUP);
            self.kernel.record(pass, &memory.bind_group, groups);
        }
    }

    /// Number of probes.
    pub fn count(&self) -> usize {
        self.count as usize
    }

    /// Time integrals of the pressure in device units, one for each probe, padded to the capacity.
    pub fn pressures(&self) -> Option<&wgpu::Buffer> {
        self.memory.as_ref().map(|memory| &memory.pressures)
    }
}
