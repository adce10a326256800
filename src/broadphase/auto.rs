//! The cheaper of the two finders.

use super::{Broadphase, DeviceBroadphase, HostBroadphase, Item};
use crate::Result;

/// Searches on the host for few items and on the device for many; the list is the same.
#[derive(Debug)]
pub struct AutoBroadphase {
    /// Items from which on the device is used.
    pub crossover: usize,
    host: HostBroadphase,
    device: DeviceBroadphase,
}

impl AutoBroadphase {
    /// Items from which on a device of its own is worth the way there and back.
    pub const CROSSOVER: usize = 10_000;

    /// Uses `device` from [`Self::CROSSOVER`] items on.
    pub fn new(device: DeviceBroadphase) -> Self {
        Self {
            crossover: Self::CROSSOVER,
            host: HostBroadphase,
            device,
        }
    }
}

impl Broadphase for AutoBroadphase {
    async fn pairs(&mut self, items: &[Item]) -> Result<Vec<[u32; 2]>> {
        if items.len() < self.crossover {
            self.host.pairs(items).await
        } else {
            self.device.pairs(items).await
        }
    }
}
