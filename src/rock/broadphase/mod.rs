//! Search for pairs that may touch. The list is complete, sorted and the same from every implementation.
//!
//! A broadphase uses the boxes as given. To keep a list for several steps, grow the
//! boxes by a skin first, and search again once an item has moved by half of it.

mod boxes;
mod device;
mod host;

pub use boxes::{Boxes, FARTHEST};
pub use device::{DeviceBroadphase, Header, PairSearch};
pub use host::HostBroadphase;

use crate::{Result, gpu::Processor};

/// Axis-aligned bounding box of an item that may touch others, already grown by the skin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Lower corner, m.
    pub min: [f64; 3],
    /// Upper corner, m.
    pub max: [f64; 3],
    /// Items of one group never pair, for example the parts of a compound, or all fixed items.
    pub group: u32,
}

impl Aabb {
    /// Whether the two boxes have a point in common.
    pub fn overlaps(&self, other: &Self) -> bool {
        // Without branches, which would be mispredicted.
        let along = |a: usize| (self.min[a] <= other.max[a]) & (other.min[a] <= self.max[a]);
        along(0) & along(1) & along(2)
    }

    /// Whether the two items may touch: their boxes overlap, and their groups differ.
    pub fn pairs_with(&self, other: &Self) -> bool {
        (self.group != other.group) & self.overlaps(other)
    }
}

/// Finds the pairs of boxes of different groups that overlap.
pub trait Broadphase {
    /// Returns the pairs (i, j), i < j, sorted, each once. Any two broadphases return the same list, bit for bit.
    ///
    /// # Errors
    /// If a device fails, or a box is not finite.
    fn pairs(&mut self, aabbs: &[Aabb]) -> impl Future<Output = Result<Vec<[u32; 2]>>>;
}

/// Largest number of storage buffers in a kernel of [`DeviceBroadphase`].
pub const MAX_STORAGE_BUFFERS: u32 = 6;

/// Searches on the host for few boxes and on the device for many; the list is the same.
///
/// The kernels are compiled when the device is first used.
#[derive(Debug)]
pub struct AutoBroadphase {
    /// Number of items from which the device is used.
    pub crossover: usize,
    device: Option<(wgpu::Device, wgpu::Queue)>,
    device_broadphase: Option<DeviceBroadphase>,
}

impl AutoBroadphase {
    /// Number of items from which a device on such a processor is used, by the records of `riprap bench --device` for 10² to
    /// 10⁵ boxes of one size and of sizes 1:100: never on a CPU (lavapipe); on a GPU, the largest number at which host and device
    /// take the same time, rounded up (694 and 300 boxes on an H100, 685 and 485 on an H200).
    pub const fn crossover_on(processor: Processor) -> usize {
        match processor {
            Processor::Cpu => usize::MAX,
            Processor::Gpu => 700,
        }
    }

    /// Uses `device` from the number of items given by [`Self::crossover_on`] for its processor.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        Self {
            crossover: Self::crossover_on(Processor::of(&device.adapter_info())),
            device: Some((device.clone(), queue.clone())),
            device_broadphase: None,
        }
    }

    /// Always searches on the host.
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

/// Sorts pairs (i, j), i < j, by counting, linear in boxes and pairs, and keeps those whose boxes
/// overlap in f64.
fn exact_pairs(aabbs: &[Aabb], found: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut ends = vec![0; aabbs.len() + 1];
    for [first, _] in found {
        ends[*first as usize + 1] += 1;
    }
    for n in 0..aabbs.len() {
        ends[n + 1] += ends[n];
    }
    // The start of each row moves to its end as the row is filled.
    let mut seconds = vec![0; found.len()];
    for [first, second] in found {
        let end = &mut ends[*first as usize];
        seconds[*end] = *second;
        *end += 1;
    }
    let mut list = Vec::with_capacity(found.len());
    let mut start = 0;
    for ((number, item), end) in (0..).zip(aabbs).zip(ends) {
        let row = &mut seconds[start..end];
        row.sort_unstable();
        let exact = row.iter().filter(|j| item.overlaps(&aabbs[**j as usize]));
        list.extend(exact.map(|j| [number, *j]));
        start = end;
    }
    list
}
