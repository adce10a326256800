//! The finders side by side.

use kit::Rig;
use riprap::{
    Result,
    rock::broadphase::{Aabb, Broadphase, DeviceBroadphase, HostBroadphase},
    wgpu,
};

pub struct Finders {
    pub rig: Rig,
    pub device: DeviceBroadphase,
}

impl Finders {
    pub fn new() -> Self {
        Self::on(Rig::new())
    }

    pub fn with_limits(limits: wgpu::Limits) -> Self {
        Self::on(Rig::with_limits(limits))
    }

    fn on(rig: Rig) -> Self {
        Self {
            device: DeviceBroadphase::new(&rig.device, &rig.queue).unwrap(),
            rig,
        }
    }

    /// The list of the device, which is that of the host.
    pub fn pairs(&mut self, items: &[Aabb]) -> Vec<[u32; 2]> {
        let found = self.rig.wait(self.device.pairs(items)).unwrap();
        let host = on_host(items).unwrap();
        let counts = (found.len(), host.len());
        assert!(found == host, "device and host: {counts:?} pairs");
        found
    }
}

pub fn on_host(items: &[Aabb]) -> Result<Vec<[u32; 2]>> {
    pollster::block_on(HostBroadphase.pairs(items))
}
