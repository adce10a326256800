//! The kernel that sums the load of the water on each body.

use super::{
    Counts, Hull,
    hulls::{MAX_LOOP_ITERATIONS, loop_iterations},
    neighbour_lists::Buffers,
};
use crate::{
    Result,
    gpu::{
        bins::{WORKGROUP, uniform},
        kernel::Kernel,
    },
};

/// The kernel with its bind groups, one for each range of particles.
#[derive(Debug)]
pub(super) struct BodyLoads {
    kernel: Kernel,
    bind_groups: Vec<wgpu::BindGroup>,
}

impl BodyLoads {
    /// Loads from the forces on boundary particles.
    pub fn of_boundary(
        device: &wgpu::Device,
        kernel: Kernel,
        buffers: &Buffers<'_>,
    ) -> Result<Self> {
        let bind_groups = vec![kernel.bind(device, buffers)?];
        Ok(Self {
            kernel,
            bind_groups,
        })
    }

    /// Loads from the penalty forces of `hulls`. On software adapters a dispatch covers a range of particles, so that
    /// no invocation exceeds [`MAX_LOOP_ITERATIONS`].
    pub fn of_hulls(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        kernel: Kernel,
        counts: Counts,
        hulls: &[Hull],
        buffers: &Buffers<'_>,
    ) -> Result<Self> {
        let of_body = |body| loop_iterations(hulls.iter().filter(|hull| hull.body == body));
        let most = (0..counts.loaded_bodies).map(of_body).max().unwrap_or(1);
        let range = match device.adapter_info().device_type {
            wgpu::DeviceType::Cpu => WORKGROUP * (MAX_LOOP_ITERATIONS / most).max(1),
            _ => counts.fluid.max(1),
        };
        let mut bind_groups = Vec::new();
        for first in (0..counts.fluid).step_by(range as usize) {
            let end = first.saturating_add(range).min(counts.fluid);
            let range = uniform(device, "range of particles", 8);
            queue.write_buffer(&range, 0, bytemuck::cast_slice(&[first, end]));
            let mut all = buffers.to_vec();
            all.push(("range", &range));
            bind_groups.push(kernel.bind(device, &all)?);
        }
        Ok(Self {
            kernel,
            bind_groups,
        })
    }

    /// Records the loads of the first `bodies` bodies.
    pub fn record(&self, pass: &mut wgpu::ComputePass<'_>, bodies: u32) {
        for bind_group in &self.bind_groups {
            self.kernel.record(pass, bind_group, bodies);
        }
    }
}

/// Index of the first hull of each body, and the number of hulls as the last entry.
pub(super) fn hull_starts(hulls: &[Hull], bodies: u32) -> Vec<u32> {
    let first = |body: u32| hulls.partition_point(|hull| hull.body < body) as u32;
    (0..=bodies).map(first).collect()
}
