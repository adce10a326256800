//! The kernel that adds up what the water does to each body.

use super::{
    Hull, Numbers,
    hulls::{TURNS, turns},
    near::Buffers,
};
use crate::{
    Result,
    kernel::Kernel,
    search::{WORKGROUP, uniform},
};

/// The kernel, and what it is bound to: one range of particles after the other where it looks at all of them.
#[derive(Debug)]
pub(super) struct Loads {
    kernel: Kernel,
    bound: Vec<wgpu::BindGroup>,
}

impl Loads {
    /// The forces on shells.
    pub fn of_shells(device: &wgpu::Device, kernel: Kernel, buffers: &Buffers<'_>) -> Result<Self> {
        let bound = vec![kernel.bind(device, buffers)?];
        Ok(Self { kernel, bound })
    }

    /// The reaction of the push of `hulls`.
    pub fn of_hulls(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        kernel: Kernel,
        (numbers, hulls): (Numbers, &[Hull]),
        buffers: &Buffers<'_>,
    ) -> Result<Self> {
        let of = |body| turns(hulls.iter().filter(|hull| hull.body == body));
        let most = (0..numbers.loaded).map(of).max().unwrap_or(1);
        let range = match device.adapter_info().device_type {
            wgpu::DeviceType::Cpu => WORKGROUP * (TURNS / most).max(1),
            _ => numbers.water.max(1),
        };
        let mut bound = Vec::new();
        for first in (0..numbers.water).step_by(range as usize) {
            let end = first.saturating_add(range).min(numbers.water);
            let range = uniform(device, "range of particles", 8);
            queue.write_buffer(&range, 0, bytemuck::cast_slice(&[first, end]));
            let mut all = buffers.to_vec();
            all.push(("range", &range));
            bound.push(kernel.bind(device, &all)?);
        }
        Ok(Self { kernel, bound })
    }

    /// Records the loads of `bodies`.
    pub fn record(&self, pass: &mut wgpu::ComputePass<'_>, bodies: u32) {
        for bound in &self.bound {
            self.kernel.record(pass, bound, bodies);
        }
    }
}

/// The first of `hulls` of each of so many `bodies`, and one more.
pub(super) fn starts(hulls: &[Hull], bodies: u32) -> Vec<u32> {
    let first = |body: u32| hulls.partition_point(|hull| hull.body < body) as u32;
    (0..=bodies).map(first).collect()
}
