//! The kernels that compare each box with its candidates, once to count pairs and once to list them.

use crate::{
    Result,
    gpu::{
        bins::{BinsOf, FEWER_BOXES, Scan, ScanOf, WORKGROUP, at_most, storage, uniform},
        kernel::Kernel,
        link::Program,
    },
};
use bytemuck::{Pod, Zeroable};

/// Candidates that an invocation compares with its box.
const SLICE: u32 = 8192;

/// What a comparison knows, as the kernels have it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Search {
    /// Levels that have boxes.
    pub levels: u32,
    /// Invocations of a box.
    pub slices: u32,
    /// The pair that the first place of the list is for.
    pub first_pair: u32,
}

/// What a count finds, as the kernels have it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Header {
    /// Candidates of the box that has most, if some were not looked at.
    pub candidates: u32,
    /// Pairs of all boxes.
    pub pairs: u32,
}

#[derive(Debug)]
pub(super) struct Comparison {
    count: Kernel,
    write: Kernel,
    search: wgpu::Buffer,
    /// A [`Header`].
    pub(super) header: wgpu::Buffer,
}

/// Pairs of each invocation, then pairs before each.
#[derive(Debug)]
pub(super) struct Hits {
    pub(super) slices: u32,
    groups: u32,
    counts: wgpu::Buffer,
    scan: ScanOf,
    bind: wgpu::BindGroup,
}

/// Room for pairs.
#[derive(Debug)]
pub(super) struct List {
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
            search: uniform(device, "search", size_of::<Search>() as u64),
            header: storage(device, "header", size_of::<Header>() as u64),
        })
    }

    /// Prepares to count with so many invocations that all `candidates` of a box are looked at.
    pub(super) fn hits(
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
        let counts = storage(device, "counts of pairs", bytes);
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
        let list = storage(device, "pairs", 8 * u64::from(capacity));
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
    pub(super) fn write_search(&self, queue: &wgpu::Queue, search: Search) {
        queue.write_buffer(&self.search, 0, bytemuck::bytes_of(&search));
    }

    /// Records the count of pairs, the places of them, and the header.
    pub(super) fn record_count(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        scan: &Scan,
        hits: &Hits,
    ) {
        encoder.clear_buffer(&self.header, 0, None);
        encoder.clear_buffer(&hits.counts, 0, None);
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            self.count.record(&mut pass, &hits.bind, hits.groups);
            scan.record(&mut pass, &hits.scan);
        }
        encoder.copy_buffer_to_buffer(hits.scan.total(), 0, &self.header, 4, 4);
    }

    /// Records the writing of the pairs that the list has room for.
    pub(super) fn record_write(&self, encoder: &mut wgpu::CommandEncoder, list: &List) {
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
    /// Whether more room would not help for as many pairs.
    pub(super) fn suffices(&self, device: &wgpu::Device, pairs: u32) -> bool {
        self.capacity >= pairs.min(most(device))
    }
}

/// Pairs that a binding holds.
fn most(device: &wgpu::Device) -> u32 {
    let limits = device.limits();
    let bytes = limits
        .max_storage_buffer_binding_size
        .min(limits.max_buffer_size);
    (bytes / 8).try_into().unwrap_or(u32::MAX)
}
