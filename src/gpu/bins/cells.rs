//! Williams, Perkins & Cook 2004, CGRID: sorts boxes into buckets of cells by count, scan and scatter.

use super::{DeviceBox, FEWER_BOXES, Level, MAX_LEVELS, Scan, ScanOf, WORKGROUP, at_most};
use crate::gpu::buffers::zeroed;
use crate::{
    Result,
    gpu::{kernel::Kernel, link::Program},
};

/// The kernels that sort boxes into buckets.
#[derive(Debug)]
pub struct Bins {
    count: Kernel,
    scatter: Kernel,
}

/// Buffers and bindings for a number of boxes, ready to be recorded.
#[derive(Debug)]
pub struct BinsOf {
    /// Number of boxes.
    pub items: u32,
    boxes: wgpu::Buffer,
    /// The levels: scale and longest edge of each.
    pub levels: wgpu::Buffer,
    /// Index of the first box of each bucket, and the total number of boxes.
    pub starts: wgpu::Buffer,
    /// Lowest group, with its bits inverted, and highest group of each bucket; zeros if it is empty.
    pub groups: wgpu::Buffer,
    /// The boxes, sorted by bucket.
    pub entries: wgpu::Buffer,
    scan: ScanOf,
    count: wgpu::BindGroup,
    scatter: wgpu::BindGroup,
}

/// Number of buckets for a number of items: a power of two, at least two per item and at least 64.
pub(crate) fn buckets(items: u32) -> u32 {
    (2 * items).next_power_of_two().max(64)
}

impl Bins {
    /// Compiles the kernels.
    ///
    /// # Errors
    /// [`crate::Error::Limit`] if the device cannot run them.
    pub fn new(device: &wgpu::Device) -> Result<Self> {
        let kernel = |name| Kernel::new(device, &Program::new(name).link()?, name, &[]);
        Ok(Self {
            count: kernel("bin_count")?,
            scatter: kernel("bin_scatter")?,
        })
    }

    /// Creates the buffers for `items` boxes, at least one.
    ///
    /// # Errors
    /// [`crate::Error::Limit`] if the device cannot bind them.
    pub fn of(&self, device: &wgpu::Device, scan: &Scan, items: u32) -> Result<BinsOf> {
        let n = u64::from(items);
        let buckets = u64::from(buckets(items));
        let bytes = n * size_of::<DeviceBox>() as u64;
        at_most(device, "boxes", bytes, FEWER_BOXES)?;
        at_most(device, "buckets", 8 * buckets, FEWER_BOXES)?;
        let levels = (MAX_LEVELS * size_of::<Level>()) as u64;
        let boxes = zeroed(device, "boxes", bytes);
        let levels = zeroed(device, "levels", levels);
        let starts = zeroed(device, "starts of buckets", 4 * (buckets + 1));
        let ranks = zeroed(device, "ranks in buckets", 4 * n);
        let groups = zeroed(device, "groups of buckets", 8 * buckets);
        let entries = zeroed(device, "sorted boxes", bytes);
        let buffers = [
            ("boxes", &boxes),
            ("levels", &levels),
            ("counts", &starts),
            ("starts", &starts),
            ("ranks", &ranks),
            ("groups_in", &groups),
            ("entries_out", &entries),
        ];
        Ok(BinsOf {
            items,
            scan: scan.of(device, &starts)?,
            count: self.count.bind(device, &buffers)?,
            scatter: self.scatter.bind(device, &buffers)?,
            boxes,
            levels,
            starts,
            groups,
            entries,
        })
    }

    /// Records the sorting of the boxes last passed to [`BinsOf::write`].
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder, scan: &Scan, of: &BinsOf) {
        encoder.clear_buffer(&of.starts, 0, None);
        encoder.clear_buffer(&of.groups, 0, None);
        let mut pass = encoder.begin_compute_pass(&Default::default());
        let groups = of.items.div_ceil(WORKGROUP);
        self.count.record(&mut pass, &of.count, groups);
        scan.record(&mut pass, &of.scan);
        self.scatter.record(&mut pass, &of.scatter, groups);
    }
}

impl BinsOf {
    /// Uploads boxes, [`BinsOf::items`] of them, and their levels.
    pub fn write(&self, queue: &wgpu::Queue, boxes: &[DeviceBox], levels: &[Level]) {
        queue.write_buffer(&self.boxes, 0, bytemuck::cast_slice(boxes));
        queue.write_buffer(&self.levels, 0, bytemuck::cast_slice(levels));
    }
}
