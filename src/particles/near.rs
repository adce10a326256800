//! The sums over neighbours: straight from the cells, or from lists that are made once for several steps.

use super::{Frame, Neighbours, Setup, program};
use crate::{
    Result,
    kernel::Kernel,
    search::{WORKGROUP, storage, uniform},
};
use std::f64::consts::PI;

/// Room in a list for the neighbours of the lattice and more: water that is squeezed or thrown together has some
/// tenths more.
const ROOM: f64 = 1.3;
/// Room that a list has at least, and what it grows by.
const FEW: u32 = 16;

/// Named buffers.
pub(super) type Buffers<'a> = [(&'a str, &'a wgpu::Buffer)];

/// The kernels that meet all pairs of some particles with water: the one that makes their lists, and two sums.
pub(super) type Names = [&'static str; 3];

/// The passes that meet all pairs of some particles with water.
#[derive(Debug)]
pub(super) struct Near {
    /// If there are lists.
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

/// Room for the neighbours of a particle of the water in a list.
pub(super) fn usual_room(setup: &Setup, frame: &Frame) -> u32 {
    let reach = 2.0 * setup.smoothing + frame.skin;
    let around = if setup.plane {
        PI * reach.powi(2)
    } else {
        4.0 / 3.0 * PI * reach.powi(3)
    };
    (ROOM * around).ceil() as u32 + FEW
}

/// Room for the water around a particle of a shell: most have water on one side only.
pub(super) fn shell_room(setup: &Setup, frame: &Frame) -> u32 {
    usual_room(setup, frame) / 2
}

/// Room for `crowd` neighbours and some more; 0 for nobody.
pub(super) fn more_room(crowd: u32) -> u32 {
    match crowd {
        0 => 0,
        _ => crowd + crowd / 4 + FEW,
    }
}

impl Near {
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        (setup, frame): (&Setup, &Frame),
        [lists, first, second]: Names,
        (count, capacity): (u32, u32),
        buffers: &Buffers<'_>,
    ) -> Result<Self> {
        let mut constants = program::constants(setup, frame);
        constants.push(("CAPACITY", capacity.into()));
        let kernel = |name: &str| {
            let linked = program::program(setup, frame, name).link()?;
            Kernel::new(device, &linked, name, &constants)
        };
        let (first, second) = (kernel(first)?, kernel(second)?);
        if setup.neighbours == Neighbours::Cells {
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
        let lists = kernel(lists)?;
        let counts = storage(
            device,
            "neighbours of particles",
            8 * u64::from(count.max(1)),
        );
        let limits = device.limits();
        let most = limits
            .max_storage_buffer_binding_size
            .min(limits.max_buffer_size);
        // Whole interleaved groups of lists.
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
            let near = storage(device, "lists of neighbours", group * u64::from(groups));
            let range = uniform(device, "range of particles", 8);
            queue.write_buffer(&range, 0, bytemuck::cast_slice(&[start, end]));
            let mut all = buffers.to_vec();
            all.extend([
                ("near", &near),
                ("near_out", &near),
                ("near_counts", &counts),
                ("near_counts_out", &counts),
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

    /// Records the lists, if there are any.
    pub fn record_lists(&self, pass: &mut wgpu::ComputePass<'_>) {
        for range in &self.ranges {
            if let (Some(lists), Some(bound)) = (&self.lists, &range.lists) {
                lists.record(pass, bound, range.groups);
            }
        }
    }

    /// Records the first sums.
    pub fn record_first(&self, pass: &mut wgpu::ComputePass<'_>) {
        for range in &self.ranges {
            self.first.record(pass, &range.first, range.groups);
        }
    }

    /// Records the second sums.
    pub fn record_second(&self, pass: &mut wgpu::ComputePass<'_>) {
        for range in &self.ranges {
            self.second.record(pass, &range.second, range.groups);
        }
    }
}
