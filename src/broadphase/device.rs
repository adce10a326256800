//! The search on the device: boxes into bins, a count of their pairs, places by a scan, the list.

use super::{Boxes, Broadphase, Item, list};
use crate::{
    Error, Result,
    kernel::Kernel,
    link::Program,
    readback::Readback,
    search::{Bins, BinsOf, Scan, ScanOf, WORKGROUP, at_most, storage, uniform},
};
use bytemuck::{Pod, Zeroable};

/// Candidates that an invocation compares with its box.
const SLICE: u32 = 8192;

/// Finds pairs on the caller's device, in O(N) for all mixtures of sizes.
///
/// Buffers are kept from call to call, for as many items as the last call had. Nothing blocks:
/// the caller polls the device while it awaits the list.
///
/// ```
/// use riprap::{broadphase::DeviceBroadphase, wgpu};
/// let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
/// let finder = DeviceBroadphase::new(&device, &queue)?;
/// # Ok::<(), riprap::Error>(())
/// ```
#[derive(Debug)]
pub struct DeviceBroadphase {
    device: wgpu::Device,
    queue: wgpu::Queue,
    bins: Bins,
    scan: Scan,
    count: Kernel,
    write: Kernel,
    search: wgpu::Buffer,
    header: wgpu::Buffer,
    readback: Readback,
    prepared: Option<Prepared>,
}

/// The buffers of a number of items.
#[derive(Debug)]
struct Prepared {
    items: u32,
    sorted: BinsOf,
    hits: Hits,
    list: Option<List>,
}

/// Pairs of each invocation, then pairs before each.
#[derive(Debug)]
struct Hits {
    slices: u32,
    counts: wgpu::Buffer,
    scan: ScanOf,
    bind: wgpu::BindGroup,
}

/// Room for pairs.
#[derive(Debug)]
struct List {
    capacity: u32,
    pairs: wgpu::Buffer,
    bind: wgpu::BindGroup,
}

/// What a search knows, as the kernels have it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Search {
    /// Levels that have items.
    pub levels: u32,
    /// Invocations of an item.
    pub slices: u32,
    /// The pair that the first place of the list is for.
    pub first_pair: u32,
}

/// What a count finds, as the kernels have it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Header {
    /// Candidates of the item that has most, if some were not looked at.
    pub candidates: u32,
    /// Pairs of all items.
    pub pairs: u32,
}

impl DeviceBroadphase {
    /// Compiles the kernels.
    ///
    /// # Errors
    /// [`Error::Limit`] if the device cannot run them: they want six storage buffers.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self> {
        let pairs = |found| {
            let program = Program::new("pairs").slot("found", found).link()?;
            Kernel::new(device, &program, "pairs", &[("SLICE", SLICE.into())])
        };
        Ok(Self {
            bins: Bins::new(device)?,
            scan: Scan::new(device)?,
            count: pairs("found_count")?,
            write: pairs("found_write")?,
            search: uniform(device, "search", size_of::<Search>() as u64),
            header: storage(device, "header", size_of::<Header>() as u64),
            readback: Readback::default(),
            prepared: None,
            device: device.clone(),
            queue: queue.clone(),
        })
    }

    fn prepare(&self, items: u32) -> Result<Prepared> {
        let sorted = self.bins.of(&self.device, &self.scan, items)?;
        Ok(Prepared {
            hits: self.hits(&sorted, items, 1)?,
            items,
            sorted,
            list: None,
        })
    }

    fn hits(&self, sorted: &BinsOf, items: u32, slices: u32) -> Result<Hits> {
        let bytes = 4 * (u64::from(items) * u64::from(slices) + 1);
        at_most(&self.device, "counts of pairs", bytes)?;
        let counts = storage(&self.device, "counts of pairs", bytes);
        let mut buffers = self.buffers(sorted);
        buffers.extend([("hits", &counts), ("header", &self.header)]);
        Ok(Hits {
            slices,
            scan: self.scan.of(&self.device, &counts)?,
            bind: self.count.bind(&self.device, &buffers)?,
            counts,
        })
    }

    /// Room for `pairs`, or for as many as a binding holds.
    fn list(&self, sorted: &BinsOf, hits: &Hits, pairs: u32) -> Result<List> {
        let limits = self.device.limits();
        let bytes = limits
            .max_storage_buffer_binding_size
            .min(limits.max_buffer_size);
        let capacity = pairs.min((bytes / 8).try_into().unwrap_or(u32::MAX));
        let list = storage(&self.device, "pairs", 8 * u64::from(capacity));
        let mut buffers = self.buffers(sorted);
        buffers.extend([("pair_starts", &hits.counts), ("pair_list", &list)]);
        Ok(List {
            capacity,
            bind: self.write.bind(&self.device, &buffers)?,
            pairs: list,
        })
    }

    fn buffers<'a>(&'a self, sorted: &'a BinsOf) -> Vec<(&'static str, &'a wgpu::Buffer)> {
        vec![
            ("entries", &sorted.entries),
            ("starts", &sorted.starts),
            ("groups_of", &sorted.groups),
            ("levels", &sorted.levels),
            ("search", &self.search),
        ]
    }

    fn tell(&self, levels: u32, slices: u32, first_pair: u32) {
        let search = Search {
            levels,
            slices,
            first_pair,
        };
        self.queue
            .write_buffer(&self.search, 0, bytemuck::bytes_of(&search));
    }

    /// Sorts the boxes if asked to, counts their pairs and finds the places of them.
    async fn count(&mut self, prepared: &Prepared, levels: u32, sort: bool) -> Result<Header> {
        let Prepared {
            items,
            sorted,
            hits,
            ..
        } = prepared;
        self.tell(levels, hits.slices, 0);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        if sort {
            self.bins.record(&mut encoder, &self.scan, sorted);
        }
        encoder.clear_buffer(&self.header, 0, None);
        encoder.clear_buffer(&hits.counts, 0, None);
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            let groups = (items * hits.slices).div_ceil(WORKGROUP);
            self.count.record(&mut pass, &hits.bind, groups);
            self.scan.record(&mut pass, &hits.scan);
        }
        encoder.copy_buffer_to_buffer(hits.scan.total(), 0, &self.header, 4, 4);
        self.queue.submit([encoder.finish()]);
        let read = self
            .readback
            .read(&self.device, &self.queue, &self.header, 1);
        let header: Vec<Header> = read.await?;
        Ok(header[0])
    }

    /// The list, in as many parts as its room asks for.
    async fn write(
        &mut self,
        prepared: &Prepared,
        levels: u32,
        pairs: u32,
    ) -> Result<Vec<[u32; 2]>> {
        let Some(list) = &prepared.list else {
            return Ok(Vec::new());
        };
        let slices = prepared.hits.slices;
        let mut found = Vec::with_capacity(pairs as usize);
        while found.len() < pairs as usize {
            let first = found.len() as u32;
            self.tell(levels, slices, first);
            let mut encoder = self.device.create_command_encoder(&Default::default());
            {
                let mut pass = encoder.begin_compute_pass(&Default::default());
                let groups = (prepared.items * slices).div_ceil(WORKGROUP);
                self.write.record(&mut pass, &list.bind, groups);
            }
            self.queue.submit([encoder.finish()]);
            let part = (pairs - first).min(list.capacity) as usize;
            let read = self
                .readback
                .read(&self.device, &self.queue, &list.pairs, part);
            let part: Vec<[u32; 2]> = read.await?;
            found.extend(part);
        }
        Ok(found)
    }
}

impl Broadphase for DeviceBroadphase {
    async fn pairs(&mut self, items: &[Item]) -> Result<Vec<[u32; 2]>> {
        let Boxes { boxes, levels } = Boxes::new(items)?;
        if items.len() < 2 {
            return Ok(Vec::new());
        }
        let number = items.len() as u32;
        let mut prepared = match self.prepared.take() {
            Some(prepared) if prepared.items == number => prepared,
            _ => self.prepare(number)?,
        };
        prepared.sorted.write(&self.queue, &boxes, &levels);
        let level_count = levels.len() as u32;
        let mut header = self.count(&prepared, level_count, true).await?;
        if header.candidates > 0 {
            let slices = header.candidates.div_ceil(SLICE);
            prepared.hits = self.hits(&prepared.sorted, number, slices)?;
            prepared.list = None;
            header = self.count(&prepared, level_count, false).await?;
        }
        if header.pairs == u32::MAX {
            return Err(Error::Limit {
                name: "pairs of items".into(),
                wants: header.pairs.into(),
                has: u64::from(u32::MAX) - 1,
                remedy: "nearly everything overlaps; look for what made the boxes so large".into(),
            });
        }
        let room = prepared.list.as_ref().map_or(0, |list| list.capacity);
        if room < header.pairs {
            prepared.list = Some(self.list(&prepared.sorted, &prepared.hits, header.pairs)?);
        }
        let found = self.write(&prepared, level_count, header.pairs).await?;
        self.prepared = Some(prepared);
        // What f32 could not tell apart goes now.
        let exact: Vec<_> = found
            .into_iter()
            .filter(|&[i, j]| items[i as usize].overlaps(&items[j as usize]))
            .collect();
        Ok(list::sort(items.len(), &exact))
    }
}
