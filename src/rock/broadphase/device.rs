//! The search on the device: boxes into bins, a count of their pairs, places by a scan, the list.

use super::{
    Aabb, Boxes, Broadphase,
    comparison::{Comparison, Header, Hits, List, Search},
    sorted_pairs,
};
use crate::{
    Error, Result,
    gpu::{
        bins::{Bins, BinsOf, Scan},
        readback::Readback,
    },
};

/// Finds pairs on the caller's device, in O(N) for all mixtures of sizes.
///
/// Buffers are kept from call to call, for as many boxes as the last call had. Nothing blocks:
/// the caller polls the device while it awaits the list.
///
/// ```
/// use riprap::{rock::broadphase::DeviceBroadphase, wgpu};
/// let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
/// let broadphase = DeviceBroadphase::new(&device, &queue)?;
/// # Ok::<(), riprap::Error>(())
/// ```
#[derive(Debug)]
pub struct DeviceBroadphase {
    device: wgpu::Device,
    queue: wgpu::Queue,
    scan: Scan,
    bins: Bins,
    comparison: Comparison,
    readback: Readback,
    prepared: Option<Prepared>,
}

/// The buffers of a number of boxes.
#[derive(Debug)]
struct Prepared {
    sorted: BinsOf,
    hits: Hits,
    list: Option<List>,
}

impl DeviceBroadphase {
    /// Compiles the kernels.
    ///
    /// # Errors
    /// [`Error::Limit`] if the device cannot run them: they want six storage buffers.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self> {
        Ok(Self {
            scan: Scan::new(device)?,
            bins: Bins::new(device)?,
            comparison: Comparison::new(device)?,
            readback: Readback::default(),
            prepared: None,
            device: device.clone(),
            queue: queue.clone(),
        })
    }

    fn prepare(&self, aabbs: u32) -> Result<Prepared> {
        let sorted = self.bins.of(&self.device, &self.scan, aabbs)?;
        let hits = self.comparison.hits(&self.device, &self.scan, &sorted, 0)?;
        Ok(Prepared {
            hits,
            sorted,
            list: None,
        })
    }

    /// Sorts the boxes, counts their pairs and finds the places of them.
    async fn count(&mut self, prepared: &mut Prepared, levels: u32) -> Result<Header> {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        self.bins.record(&mut encoder, &self.scan, &prepared.sorted);
        loop {
            let search = Search {
                levels,
                slices: prepared.hits.slices,
                first_pair: 0,
            };
            self.comparison.write_search(&self.queue, search);
            self.comparison
                .record_count(&mut encoder, &self.scan, &prepared.hits);
            self.queue.submit([encoder.finish()]);
            let header = &self.comparison.header;
            let read = self.readback.read(&self.device, &self.queue, header, 1);
            let header: Vec<Header> = read.await?;
            let header = header[0];
            if header.candidates == 0 {
                return Ok(header);
            }
            // Somebody has more neighbours than one invocation looks at.
            let Prepared { sorted, hits, list } = prepared;
            let candidates = header.candidates;
            *hits = self
                .comparison
                .hits(&self.device, &self.scan, sorted, candidates)?;
            *list = None;
            encoder = self.device.create_command_encoder(&Default::default());
        }
    }

    /// The list, in as many parts as its room asks for.
    async fn write(
        &mut self,
        prepared: &mut Prepared,
        levels: u32,
        pairs: u32,
    ) -> Result<Vec<[u32; 2]>> {
        let list = match prepared.list.take() {
            Some(list) if list.suffices(&self.device, pairs) => list,
            _ if pairs == 0 => return Ok(Vec::new()),
            _ => {
                let Prepared { sorted, hits, .. } = prepared;
                self.comparison.list(&self.device, sorted, hits, pairs)?
            }
        };
        let mut found: Vec<[u32; 2]> = Vec::with_capacity(pairs as usize);
        while found.len() < pairs as usize {
            let search = Search {
                levels,
                slices: prepared.hits.slices,
                first_pair: found.len() as u32,
            };
            self.comparison.write_search(&self.queue, search);
            let mut encoder = self.device.create_command_encoder(&Default::default());
            self.comparison.record_write(&mut encoder, &list);
            self.queue.submit([encoder.finish()]);
            let part = (pairs - search.first_pair).min(list.capacity) as usize;
            let read = self
                .readback
                .read(&self.device, &self.queue, &list.pairs, part);
            found.append(&mut read.await?);
        }
        prepared.list = Some(list);
        Ok(found)
    }
}

impl Broadphase for DeviceBroadphase {
    async fn pairs(&mut self, aabbs: &[Aabb]) -> Result<Vec<[u32; 2]>> {
        let Boxes { boxes, levels } = Boxes::new(aabbs)?;
        if aabbs.len() < 2 {
            return Ok(Vec::new());
        }
        let number = aabbs.len() as u32;
        let mut prepared = match self.prepared.take() {
            Some(prepared) if prepared.sorted.items == number => prepared,
            _ => self.prepare(number)?,
        };
        prepared.sorted.write(&self.queue, &boxes, &levels);
        let levels = levels.len() as u32;
        let Header { pairs, .. } = self.count(&mut prepared, levels).await?;
        if pairs == u32::MAX {
            return Err(Error::Limit {
                name: "pairs of items".into(),
                wants: pairs.into(),
                has: u64::from(u32::MAX) - 1,
                remedy: "nearly everything overlaps; look for what made the boxes so large".into(),
            });
        }
        let found = self.write(&mut prepared, levels, pairs).await?;
        self.prepared = Some(prepared);
        Ok(sorted_pairs::exact(aabbs, &found))
    }
}
