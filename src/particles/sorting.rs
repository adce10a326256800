//! Green (2010): particles sorted by the cells that they are in, by count, scan and scatter.

use super::kernels::FEWER_PARTICLES;
use super::{Frame, Setup, layout::Particle, program};
use crate::{
    Result,
    kernel::Kernel,
    search::{Scan, ScanOf, WORKGROUP, at_most, storage},
};

/// The kernels of a sort.
#[derive(Debug)]
pub struct Sorting {
    count: Kernel,
    keep: Kernel,
    list: Kernel,
    order: Kernel,
    scan: Scan,
}

/// The buffers of a number of particles, ready to be sorted.
#[derive(Debug)]
pub struct Sorted {
    count: u32,
    /// The particles as they come; at least one, that may be nowhere.
    pub unsorted: wgpu::Buffer,
    /// The particles by cells.
    pub sorted: wgpu::Buffer,
    /// Where each cell begins, since they were sorted last.
    pub starts: wgpu::Buffer,
    counts: wgpu::Buffer,
    scan: ScanOf,
    bound: [wgpu::BindGroup; 4],
}

impl Sorting {
    /// Compiles the kernels.
    ///
    /// # Errors
    /// [`crate::Error::Limit`] if the device cannot run them.
    pub fn new(device: &wgpu::Device, setup: &Setup, frame: &Frame) -> Result<Self> {
        let constants = program::constants(setup, frame);
        let kernel = |name| {
            let linked = program::program(setup, frame, name).link()?;
            Kernel::new(device, &linked, name, &constants)
        };
        Ok(Self {
            count: kernel("sort_count")?,
            keep: kernel("sort_keep")?,
            list: kernel("sort_list")?,
            order: kernel("sort_order")?,
            scan: Scan::new(device)?,
        })
    }

    /// Prepares the buffers for `count` particles; there is room for one at least. Only when the clock says that
    /// their order is stale will they be sorted.
    ///
    /// # Errors
    /// [`crate::Error::Limit`] if the device cannot bind them.
    pub fn of(
        &self,
        device: &wgpu::Device,
        frame: &Frame,
        clock: &wgpu::Buffer,
        count: u32,
    ) -> Result<Sorted> {
        let count = count.max(1);
        let bytes = u64::from(count) * size_of::<Particle>() as u64;
        let cells = 4 * (frame.cell_count() + 2);
        at_most(device, "particles", bytes, FEWER_PARTICLES)?;
        at_most(device, "cells of particles", cells, FEWER_PARTICLES)?;
        let unsorted = storage(device, "particles as they come", bytes);
        let sorted = storage(device, "particles by cells", bytes);
        let counts = storage(device, "numbers in cells", cells);
        let starts = storage(device, "starts of cells", cells);
        let arrivals = storage(device, "arrivals in cells", 4 * u64::from(count));
        let list = storage(device, "particles of cells", 4 * u64::from(count));
        let buffers = [
            ("unsorted", &unsorted),
            ("sorted", &sorted),
            ("counts", &counts),
            ("fresh", &counts),
            ("starts", &starts),
            ("arrivals", &arrivals),
            ("list", &list),
            ("clock", clock),
        ];
        Ok(Sorted {
            count,
            scan: self.scan.of(device, &counts)?,
            bound: [
                self.count.bind(device, &buffers)?,
                self.keep.bind(device, &buffers)?,
                self.list.bind(device, &buffers)?,
                self.order.bind(device, &buffers)?,
            ],
            unsorted,
            sorted,
            starts,
            counts,
        })
    }

    /// Records the sorting of what is in `unsorted`.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder, of: &Sorted) {
        encoder.clear_buffer(&of.counts, 0, None);
        let mut pass = encoder.begin_compute_pass(&Default::default());
        let groups = of.count.div_ceil(WORKGROUP);
        self.count.record(&mut pass, &of.bound[0], groups);
        self.scan.record(&mut pass, &of.scan);
        let cells = (of.starts.size() / 4).div_ceil(u64::from(WORKGROUP));
        self.keep.record(&mut pass, &of.bound[1], cells as u32);
        self.list.record(&mut pass, &of.bound[2], groups);
        self.order.record(&mut pass, &of.bound[3], groups);
    }
}
