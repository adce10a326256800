//! The sums over neighbours: straight from the cells, or from lists that a step makes once.

use super::{Frame, Neighbours, Scheme, Setup, program};
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

/// The passes that meet all pairs.
#[derive(Debug)]
pub(super) struct Near {
    /// Lists and the gate that they must pass, if there are lists.
    lists: Option<(Kernel, Kernel, wgpu::BindGroup)>,
    /// `accelerate`, or `mueller_density`.
    first: Kernel,
    /// `drift`, or `mueller_move`.
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

/// Room for the neighbours of a particle in a list.
pub(super) fn usual_room(setup: &Setup) -> u32 {
    let reach = 2.0 * setup.smoothing;
    let around = if setup.plane {
        PI * reach.powi(2)
    } else {
        4.0 / 3.0 * PI * reach.powi(3)
    };
    (ROOM * around).ceil() as u32 + FEW
}

/// Room for `crowd` neighbours and some more.
pub(super) fn more_room(crowd: u32) -> u32 {
    crowd + crowd / 4 + FEW
}

impl Near {
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        (setup, frame): (&Setup, &Frame),
        count: u32,
        capacity: u32,
        buffers: &Buffers<'_>,
    ) -> Result<Self> {
        let mut constants = program::constants(setup, frame);
        constants.push(("CAPACITY", capacity.into()));
        let kernel = |name: &str| {
            let linked = program::program(setup, frame, name).link()?;
            Kernel::new(device, &linked, name, &constants)
        };
        let [first, second] = match setup.scheme {
            Scheme::Delta => ["accelerate", "drift"],
            Scheme::Mueller { .. } => ["mueller_density", "mueller_move"],
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
        let (lists, admit) = (kernel("neighbours")?, kernel("admit")?);
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
        let gate = admit.bind(device, buffers)?;
        Ok(Self {
            lists: Some((lists, admit, gate)),
            first,
            second,
            ranges,
        })
    }

    /// Records the first sums: new velocities, or densities.
    pub fn record_first(&self, pass: &mut wgpu::ComputePass<'_>) {
        if let Some((lists, admit, gate)) = &self.lists {
            for range in &self.ranges {
                if let Some(bound) = &range.lists {
                    lists.record(pass, bound, range.groups);
                }
            }
            admit.record(pass, gate, 1);
        }
        for range in &self.ranges {
            self.first.record(pass, &range.first, range.groups);
        }
    }

    /// Records the second sums: new densities and places, or velocities.
    pub fn record_second(&self, pass: &mut wgpu::ComputePass<'_>) {
        for range in &self.ranges {
            self.second.record(pass, &range.second, range.groups);
        }
    }
}
