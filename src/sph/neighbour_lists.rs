//! Counting sort of particles by cell: count, scan and scatter (Green 2010), and sums over neighbours, which are found in
//! the cells or in Verlet lists.

use super::{
    CellGrid, NeighbourSearch, Setup, kernels::FEWER_PARTICLES, layout::Particle, program,
};
use crate::{
    Result,
    gpu::{
        bins::{Scan, ScanOf, WORKGROUP, at_most},
        buffers::{uniform, zeroed},
        kernel::{Kernel, largest_binding},
    },
};
use std::f64::consts::PI;

/// Capacity of a list relative to the neighbours on the initial lattice: compressed or splashing water has a few
/// tenths more.
const CAPACITY_FACTOR: f64 = 1.3;
/// Smallest capacity of a list, and smallest increase of the capacity.
const MIN_CAPACITY: u32 = 16;

/// Named buffers.
pub(super) type Buffers<'a> = [(&'a str, &'a wgpu::Buffer)];

/// The kernels over the neighbours of a set of particles.
#[derive(Clone, Copy, Debug)]
pub(super) struct PairKernels {
    /// Builds the lists.
    pub lists: &'static str,
    /// First sum.
    pub first: &'static str,
    /// Second sum.
    pub second: &'static str,
}

/// Parameters of [`NeighbourLists::new`].
#[derive(Clone, Copy, Debug)]
pub(super) struct PairPasses {
    pub kernels: PairKernels,
    /// Number of particles.
    pub count: u32,
    /// Capacity of each list.
    pub capacity: u32,
}

/// The passes over the neighbours of a set of particles.
#[derive(Debug)]
pub(super) struct NeighbourLists {
    /// `None` with [`NeighbourSearch::Cells`].
    lists: Option<Kernel>,
    first: Kernel,
    second: Kernel,
    ranges: Vec<Range>,
}

/// Particles whose lists fit one binding.
#[derive(Debug)]
struct Range {
    groups: u32,
    lists: Option<wgpu::BindGroup>,
    first: wgpu::BindGroup,
    second: wgpu::BindGroup,
}

/// Initial capacity of the list of a fluid particle.
pub(super) fn fluid_capacity(setup: &Setup, grid: &CellGrid) -> u32 {
    let radius = 2.0 * setup.smoothing + grid.skin;
    let neighbours = if setup.plane {
        PI * radius.powi(2)
    } else {
        4.0 / 3.0 * PI * radius.powi(3)
    };
    (CAPACITY_FACTOR * neighbours).ceil() as u32 + MIN_CAPACITY
}

/// Initial capacity of the list of a boundary particle: most have water on one side only.
pub(super) fn boundary_capacity(setup: &Setup, grid: &CellGrid) -> u32 {
    fluid_capacity(setup, grid) / 2
}

/// New capacity after a list of the length `overflow` exceeded the old one; 0 if no list did.
pub(super) fn grown_capacity(overflow: u32) -> u32 {
    match overflow {
        0 => 0,
        _ => overflow + overflow / 4 + MIN_CAPACITY,
    }
}

impl NeighbourLists {
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        setup: &Setup,
        grid: &CellGrid,
        passes: PairPasses,
        buffers: &Buffers<'_>,
    ) -> Result<Self> {
        let (count, capacity) = (passes.count, passes.capacity);
        let constants = program::constants(setup, grid);
        let kernel = |name: &str| {
            let linked = program::program(setup, grid, name).link()?;
            let mut constants = linked.constants_of(&constants);
            if setup.neighbours == NeighbourSearch::Lists {
                constants.push(("CAPACITY", capacity.into()));
            }
            Kernel::new(device, &linked, name, &constants)
        };
        let first = kernel(passes.kernels.first)?;
        let second = kernel(passes.kernels.second)?;
        if setup.neighbours == NeighbourSearch::Cells {
            let range = Range {
                groups: count.div_ceil(WORKGROUP),
                lists: None,
                first: first.bind(device, buffers)?,
                second: second.bind(device, buffers)?,
            };
            return Ok(Self {
                lists: None,
                ranges: vec![range],
                first,
                second,
            });
        }
        let lists = kernel(passes.kernels.lists)?;
        let counts = zeroed(device, "neighbour counts", 8 * u64::from(count.max(1)));
        let most = largest_binding(&device.limits());
        // The lists of a workgroup are interleaved, so a range is a whole number of workgroups.
        let group = u64::from(4 * WORKGROUP * capacity);
        let fits = u32::try_from(most / group)
            .unwrap_or(u32::MAX / WORKGROUP)
            .max(1);
        let longest = fits.saturating_mul(WORKGROUP).min(count.max(1));
        let mut ranges = Vec::new();
        let mut start = 0;
        while start < count.max(1) {
            let end = start.saturating_add(longest).min(count.max(1));
            let groups = (end - start).div_ceil(WORKGROUP);
            let list = zeroed(device, "neighbour lists", group * u64::from(groups));
            let range = uniform(device, "range of particles", 8);
            queue.write_buffer(&range, 0, bytemuck::cast_slice(&[start, end]));
            let mut all = buffers.to_vec();
            all.extend([
                ("neighbour_list", &list),
                ("neighbour_list_out", &list),
                ("neighbour_counts", &counts),
                ("neighbour_counts_out", &counts),
                ("range", &range),
            ]);
            ranges.push(Range {
                groups,
                lists: Some(lists.bind(device, &all)?),
                first: first.bind(device, &all)?,
                second: second.bind(device, &all)?,
            });
            start = end;
        }
        Ok(Self {
            lists: Some(lists),
            first,
            second,
            ranges,
        })
    }

    /// Records the rebuild of the lists, if there are any.
    pub fn record_lists(&self, pass: &mut wgpu::ComputePass<'_>) {
        for range in &self.ranges {
            if let (Some(lists), Some(bind_group)) = (&self.lists, &range.lists) {
                lists.record(pass, bind_group, range.groups);
            }
        }
    }

    /// Records the first sum.
    pub fn record_first(&self, pass: &mut wgpu::ComputePass<'_>) {
        for range in &self.ranges {
            self.first.record(pass, &range.first, range.groups);
        }
    }

    /// Records the second sum.
    pub fn record_second(&self, pass: &mut wgpu::ComputePass<'_>) {
        for range in &self.ranges {
            self.second.record(pass, &range.second, range.groups);
        }
    }
}

/// The kernels of the sort.
#[derive(Debug)]
pub struct CountingSort {
    count: Kernel,
    starts: Kernel,
    scatter: Kernel,
    reorder: Kernel,
    scan: Scan,
}

/// The buffers of a set of particles.
#[derive(Debug)]
pub struct SortedParticles {
    count: u32,
    /// Particles before the sort; at least one, which may be outside the domain.
    pub unsorted: wgpu::Buffer,
    /// Particles sorted by cell.
    pub sorted: wgpu::Buffer,
    /// Index of the first particle of each cell at the last sort.
    pub starts: wgpu::Buffer,
    counts: wgpu::Buffer,
    scan: ScanOf,
    bind_groups: [wgpu::BindGroup; 4],
}

impl CountingSort {
    /// Compiles the kernels.
    ///
    /// # Errors
    /// [`crate::Error::Limit`] if the device cannot run them.
    pub fn new(device: &wgpu::Device, setup: &Setup, grid: &CellGrid) -> Result<Self> {
        let constants = program::constants(setup, grid);
        let kernel = |name| {
            let linked = program::program(setup, grid, name).link()?;
            Kernel::new(device, &linked, name, &linked.constants_of(&constants))
        };
        Ok(Self {
            count: kernel("sort_count")?,
            starts: kernel("sort_starts")?,
            scatter: kernel("sort_scatter")?,
            reorder: kernel("sort_reorder")?,
            scan: Scan::new(device)?,
        })
    }

    /// Prepares the buffers for `count` particles, at least one. The kernels sort only if `clock` marks the order as
    /// stale.
    ///
    /// # Errors
    /// [`crate::Error::Limit`] if the device cannot bind them.
    pub fn buffers(
        &self,
        device: &wgpu::Device,
        grid: &CellGrid,
        clock: &wgpu::Buffer,
        count: u32,
    ) -> Result<SortedParticles> {
        let count = count.max(1);
        let bytes = u64::from(count) * size_of::<Particle>() as u64;
        let cells = 4 * (grid.cell_count() + 2);
        at_most(device, "particles", bytes, FEWER_PARTICLES)?;
        at_most(device, "cells of particles", cells, FEWER_PARTICLES)?;
        let unsorted = zeroed(device, "unsorted particles", bytes);
        let sorted = zeroed(device, "sorted particles", bytes);
        let counts = zeroed(device, "particle counts of cells", cells);
        let starts = zeroed(device, "first particles of cells", cells);
        let arrivals = zeroed(device, "arrival order in cells", 4 * u64::from(count));
        let list = zeroed(device, "particles of cells", 4 * u64::from(count));
        let buffers = [
            ("unsorted", &unsorted),
            ("sorted", &sorted),
            ("counts", &counts),
            ("new_starts", &counts),
            ("starts", &starts),
            ("arrivals", &arrivals),
            ("list", &list),
            ("clock", clock),
        ];
        Ok(SortedParticles {
            count,
            scan: self.scan.of(device, &counts)?,
            bind_groups: [
                self.count.bind(device, &buffers)?,
                self.starts.bind(device, &buffers)?,
                self.scatter.bind(device, &buffers)?,
                self.reorder.bind(device, &buffers)?,
            ],
            unsorted,
            sorted,
            starts,
            counts,
        })
    }

    /// Records the sort of `particles.unsorted` into `particles.sorted`.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder, particles: &SortedParticles) {
        encoder.clear_buffer(&particles.counts, 0, None);
        let mut pass = encoder.begin_compute_pass(&Default::default());
        let groups = particles.count.div_ceil(WORKGROUP);
        self.count
            .record(&mut pass, &particles.bind_groups[0], groups);
        self.scan.record(&mut pass, &particles.scan);
        let cells = (particles.starts.size() / 4).div_ceil(u64::from(WORKGROUP));
        self.starts
            .record(&mut pass, &particles.bind_groups[1], cells as u32);
        self.scatter
            .record(&mut pass, &particles.bind_groups[2], groups);
        self.reorder
            .record(&mut pass, &particles.bind_groups[3], groups);
    }
}
