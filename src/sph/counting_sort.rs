//! Counting sort of particles by cell: count, scan and scatter (Green 2010).

use super::kernels::FEWER_PARTICLES;
use super::{CellGrid, Setup, layout::Particle, program};
use crate::{
    Result,
    gpu::{
        bins::{Scan, ScanOf, WORKGROUP, at_most, storage},
        kernel::Kernel,
    },
};

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
        let unsorted = storage(device, "unsorted particles", bytes);
        let sorted = storage(device, "sorted particles", bytes);
        let counts = storage(device, "particle counts of cells", cells);
        let starts = storage(device, "first particles of cells", cells);
        let arrivals = storage(device, "arrival order in cells", 4 * u64::from(count));
        let list = storage(device, "particles of cells", 4 * u64::from(count));
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
