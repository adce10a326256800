//! Places in the water whose pressure somebody wants to know.

use super::kernels::FEWER_PARTICLES;
use super::near::Buffers;
use crate::{
    Result,
    kernel::Kernel,
    search::{WORKGROUP, at_most, storage},
};

/// The kernel `pressure_at` with its memory, which grows with the number of places.
#[derive(Debug)]
pub(super) struct Asked {
    kernel: Kernel,
    count: u32,
    memory: Option<Memory>,
}

#[derive(Debug)]
struct Memory {
    /// Places.
    room: u32,
    places: wgpu::Buffer,
    pressures: wgpu::Buffer,
    bound: wgpu::BindGroup,
}

impl Asked {
    /// Nothing is asked yet.
    pub fn new(kernel: Kernel) -> Self {
        Self {
            kernel,
            count: 0,
            memory: None,
        }
    }

    /// Sets the places, quanta.
    pub fn ask(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        places: &[[i32; 4]],
        others: &Buffers<'_>,
    ) -> Result<()> {
        at_most(
            device,
            "places asked about",
            16 * places.len() as u64,
            FEWER_PARTICLES,
        )?;
        self.count = places.len() as u32;
        let room = self.memory.as_ref().map_or(0, |memory| memory.room);
        if self.count > room {
            let limits = device.limits();
            let most = limits
                .max_storage_buffer_binding_size
                .min(limits.max_buffer_size)
                / 16;
            let room = (2 * u64::from(self.count)).min(most);
            let asked = storage(device, "places asked about", 16 * room);
            let pressures = storage(device, "pressures asked about", 4 * room);
            let own = [("places", &asked), ("pressures", &pressures)];
            self.memory = Some(Memory {
                room: room as u32,
                bound: self.kernel.bind(device, &[&own, others].concat())?,
                places: asked,
                pressures,
            });
        }
        if let Some(memory) = &self.memory {
            queue.write_buffer(&memory.places, 0, bytemuck::cast_slice(places));
        }
        Ok(())
    }

    /// Forgets what was added up.
    pub fn begin(&self, queue: &wgpu::Queue) {
        if let Some(memory) = &self.memory {
            queue.write_buffer(&memory.pressures, 0, &vec![0; 4 * memory.room as usize]);
        }
    }

    /// Records a step.
    pub fn record(&self, pass: &mut wgpu::ComputePass<'_>) {
        if let (Some(memory), 1..) = (&self.memory, self.count) {
            let groups = self.count.div_ceil(WORKGROUP);
            self.kernel.record(pass, &memory.bound, groups);
        }
    }

    /// How many places.
    pub fn count(&self) -> usize {
        self.count as usize
    }

    /// Sums over steps of pressure times step, in units of the device, with room for more.
    pub fn pressures(&self) -> Option<&wgpu::Buffer> {
        self.memory.as_ref().map(|memory| &memory.pressures)
    }
}
