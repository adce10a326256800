//! Sums over neighbours, which are found in the cells or in Verlet lists.

use super::{CellGrid, NeighbourSearch, Setup, program};
use crate::{
    Result,
    gpu::{
        bins::{WORKGROUP, storage, uniform},
        kernel::Kernel,
    },
};
use std::f64::consts::PI;

/// Capacity of a list relative to the neighbours on the initial lattice: compressed or splashing water has some tenths
/// more.
const CAPACITY_FACTOR: f64 = 1.3;
/// Least capacity of a list, and its least increase.
const MIN_CAPACITY: u32 = 16;

/// Named buffers.
pub(super) type Buffers<'a> = [(&'a str, &'a wgpu::Buffer)];

/// The kernels over the pairs of a set of particles with the water.
#[derive(Clone, Copy, Debug)]
pub(super) struct PairKernels {
    /// Builds the lists.
    pub lists: &'static str,
    /// First sum.
    pub first: &'static str,
    /// Second sum.
    pub second: &'static str,
}

/// What [`NeighbourLists::new`] builds.
#[derive(Clone, Copy, Debug)]
pub(super) struct PairPasses {
    pub kernels: PairKernels,
    /// Number of particles.
    pub count: u32,
    /// Capacity of each list.
    pub capacity: u32,
}

/// The passes over the pairs of a set of particles with the water.
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
        let counts = storage(device, "neighbour counts", 8 * u64::from(count.max(1)));
        let limits = device.limits();
        let most = limits
            .max_storage_buffer_binding_size
            .min(limits.max_buffer_size);
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
            let list = storage(device, "neighbour lists", group * u64::from(groups));
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
