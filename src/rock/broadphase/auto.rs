//! The cheaper of the two broadphases.

use super::{Aabb, Broadphase, DeviceBroadphase, HostBroadphase};
use crate::Result;

/// Searches on the host for few boxes and on the device for many; the list is the same.
///
/// The kernels are compiled when the device is first used.
#[derive(Debug)]
pub struct AutoBroadphase {
    /// Items from which on the device is used.
    pub crossover: usize,
    device: Option<(wgpu::Device, wgpu::Queue)>,
    device_broadphase: Option<DeviceBroadphase>,
}

impl AutoBroadphase {
    /// Items from which on a GPU is used. An estimate: the host takes 0.5 to 1 µs of CPU time an
    /// box, and two submissions that are waited for take some hundred microseconds with a usual driver.
    /// `cargo bench --bench broadphase` measures it for a device.
    pub const GPU_CROSSOVER: usize = 1000;

    /// Uses `device` from [`Self::GPU_CROSSOVER`] boxes on, and not at all if it computes on the
    /// CPU: on lavapipe a search takes 5 to 8 times the CPU time of the host's for 10³ to 10⁵ boxes
    /// of one size or of sizes 1:100, and more for fewer.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        let crossover = match device.adapter_info().device_type {
            wgpu::DeviceType::Cpu => usize::MAX,
            _ => Self::GPU_CROSSOVER,
        };
        Self {
            crossover,
            device: Some((device.clone(), queue.clone())),
            device_broadphase: None,
        }
    }

    /// Searches on the host alone.
    pub fn on_host() -> Self {
        Self {
            crossover: usize::MAX,
            device: None,
            device_broadphase: None,
        }
    }
}

impl Broadphase for AutoBroadphase {
    async fn pairs(&mut self, aabbs: &[Aabb]) -> Result<Vec<[u32; 2]>> {
        let (device, queue) = match &self.device {
            Some(device) if aabbs.len() >= self.crossover => device,
            _ => return HostBroadphase.pairs(aabbs).await,
        };
        let broadphase = match &mut self.device_broadphase {
            Some(broadphase) => broadphase,
            empty => empty.insert(DeviceBroadphase::new(device, queue)?),
        };
        broadphase.pairs(aabbs).await
    }
}
