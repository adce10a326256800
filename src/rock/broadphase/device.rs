//! The broadphase on the device: sorts boxes into bins, counts their pairs, finds their places by a scan, writes the list.

use super::{Aabb, Boxes, Broadphase, exact_pairs};
use crate::{
    Error, Result,
    gpu::{
        bins::{Bins, BinsOf, FEWER_BOXES, Scan, ScanOf, WORKGROUP, at_most},
        buffers::{uniform, zeroed},
        kernel::{Kernel, largest_binding},
        link::Program,
        readback::Readback,
    },
};
use bytemuck::{Pod, Zeroable};

/// Finds pairs on the caller's device, in O(N) for any mixture of sizes.
///
/// Buffers are reused if the number of boxes is that of the last call. No call blocks:
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

/// Buffers for a given number of boxes.
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
    /// [`Error::Limit`] if the device cannot run them: they need six storage buffers.
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

    /// Sorts the boxes, counts their pairs and finds the place of each in the list.
    async fn count(&mut self, prepared: &mut Prepared, levels: u32) -> Result<Header> {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        self.bins.record(&mut encoder, &self.scan, &prepared.sorted);
        loop {
            let search = PairSearch {
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
            // A box has more candidates than its invocations compare.
            let Prepared { sorted, hits, list } = prepared;
            let candidates = header.candidates;
            *hits = self
                .comparison
                .hits(&self.device, &self.scan, sorted, candidates)?;
            *list = None;
            encoder = self.device.create_command_encoder(&Default::default());
        }
    }

    /// The list, in as many parts as its capacity requires.
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
            let search = PairSearch {
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
        Ok(exact_pairs(aabbs, &found))
    }
}

/// Number of candidates that an invocation compares with its box.
const SLICE: u32 = 8192;

/// Parameters of the kernels, in their layout.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct PairSearch {
    /// Number of levels with boxes.
    pub levels: u32,
    /// Invocations per box.
    pub slices: u32,
    /// Number of the pair at the first place of the list.
    pub first_pair: u32,
}

/// Result of the count, in the layout of the kernels.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Header {
    /// Largest number of candidates of a box, if some were not compared.
    pub candidates: u32,
    /// Number of pairs of all boxes.
    pub pairs: u32,
}

#[derive(Debug)]
struct Comparison {
    count: Kernel,
    write: Kernel,
    search: wgpu::Buffer,
    /// A [`Header`].
    pub(super) header: wgpu::Buffer,
}

/// Number of pairs of each invocation, then its prefix sum.
#[derive(Debug)]
struct Hits {
    pub(super) slices: u32,
    groups: u32,
    counts: wgpu::Buffer,
    scan: ScanOf,
    bind: wgpu::BindGroup,
}

/// Memory for pairs.
#[derive(Debug)]
struct List {
    pub(super) capacity: u32,
    pub(super) pairs: wgpu::Buffer,
    groups: u32,
    bind: wgpu::BindGroup,
}

impl Comparison {
    pub(super) fn new(device: &wgpu::Device) -> Result<Self> {
        let pairs = |found| {
            let program = Program::new("pairs").slot("found", found).link()?;
            Kernel::new(device, &program, "pairs", &[("SLICE", SLICE.into())])
        };
        Ok(Self {
            count: pairs("found_count")?,
            write: pairs("found_write")?,
            search: uniform(device, "search", size_of::<PairSearch>() as u64),
            header: zeroed(device, "header", size_of::<Header>() as u64),
        })
    }

    /// Prepares to count with enough invocations to compare all `candidates` of a box.
    fn hits(
        &self,
        device: &wgpu::Device,
        scan: &Scan,
        sorted: &BinsOf,
        candidates: u32,
    ) -> Result<Hits> {
        let slices = candidates.div_ceil(SLICE).max(1);
        let invocations = u64::from(sorted.items) * u64::from(slices);
        let bytes = 4 * (invocations + 1);
        at_most(device, "counts of pairs", bytes, FEWER_BOXES)?;
        let counts = zeroed(device, "counts of pairs", bytes);
        let mut buffers = self.buffers(sorted);
        buffers.extend([("hits", &counts), ("header", &self.header)]);
        Ok(Hits {
            slices,
            groups: invocations.div_ceil(WORKGROUP.into()) as u32,
            scan: scan.of(device, &counts)?,
            bind: self.count.bind(device, &buffers)?,
            counts,
        })
    }

    /// Prepares to list `pairs`, or as many of them as a binding holds.
    pub(super) fn list(
        &self,
        device: &wgpu::Device,
        sorted: &BinsOf,
        hits: &Hits,
        pairs: u32,
    ) -> Result<List> {
        let capacity = pairs.min(most(device));
        let list = zeroed(device, "pairs", 8 * u64::from(capacity));
        let mut buffers = self.buffers(sorted);
        buffers.extend([("pair_starts", &hits.counts), ("pair_list", &list)]);
        Ok(List {
            capacity,
            groups: hits.groups,
            bind: self.write.bind(device, &buffers)?,
            pairs: list,
        })
    }

    /// Writes the parameters of the next submission.
    fn write_search(&self, queue: &wgpu::Queue, search: PairSearch) {
        queue.write_buffer(&self.search, 0, bytemuck::bytes_of(&search));
    }

    /// Records the count of pairs, its prefix sum, and the header.
    fn record_count(&self, encoder: &mut wgpu::CommandEncoder, scan: &Scan, hits: &Hits) {
        encoder.clear_buffer(&self.header, 0, None);
        encoder.clear_buffer(&hits.counts, 0, None);
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            self.count.record(&mut pass, &hits.bind, hits.groups);
            scan.record(&mut pass, &hits.scan);
        }
        encoder.copy_buffer_to_buffer(hits.scan.total(), 0, &self.header, 4, 4);
    }

    /// Records the writing of as many pairs as the list holds.
    fn record_write(&self, encoder: &mut wgpu::CommandEncoder, list: &List) {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        self.write.record(&mut pass, &list.bind, list.groups);
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
}

impl List {
    /// Whether the list holds as many of `pairs` as a binding allows.
    fn suffices(&self, device: &wgpu::Device, pairs: u32) -> bool {
        self.capacity >= pairs.min(most(device))
    }
}

/// Largest number of pairs in a binding.
fn most(device: &wgpu::Device) -> u32 {
    (largest_binding(&device.limits()) / 8)
        .try_into()
        .unwrap_or(u32::MAX)
}
