//! Every broadphase returns the list that follows from the definition.

mod degenerate;
mod kernels;
mod scan;
mod search;

use kit::Rig;
use riprap::{
    Result,
    rock::broadphase::{Aabb, Broadphase, DeviceBroadphase, HostBroadphase},
    wgpu,
};

/// The broadphase on the device, for comparison with that on the host.
struct Finders {
    rig: Rig,
    device: DeviceBroadphase,
}

impl Finders {
    fn new() -> Self {
        Self::on(Rig::new())
    }

    fn with_limits(limits: wgpu::Limits) -> Self {
        Self::on(Rig::with_limits(limits))
    }

    fn on(rig: Rig) -> Self {
        Self {
            device: DeviceBroadphase::new(&rig.device, &rig.queue).unwrap(),
            rig,
        }
    }

    /// The list of the device; asserts that the host finds the same.
    fn pairs(&mut self, items: &[Aabb]) -> Vec<[u32; 2]> {
        let found = self.rig.wait(self.device.pairs(items)).unwrap();
        let host = on_host(items).unwrap();
        let counts = (found.len(), host.len());
        assert!(found == host, "device and host: {counts:?} pairs");
        found
    }
}

fn on_host(items: &[Aabb]) -> Result<Vec<[u32; 2]>> {
    pollster::block_on(HostBroadphase.pairs(items))
}
