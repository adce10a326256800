//! The sums over neighbours: straight from the cells, or from lists that a step makes once.

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

/// The passes that meet all pairs.
#[derive(Debug)]
pub(super) struct Near {
    /// Lists and the gate that they must pass, if there are lists.
    lists: Option<(Kernel, Kernel, wgpu::BindGroup)>,
    accelerate: Kernel,
    drift: Kernel,
    ranges: Vec<Range>,
}

/// Particles whose lists fit one binding.
#[derive(Debug)]
struct Range {
    groups: u32,
    lists: Option<wgpu::BindGroup>,
    accelerate: wgpu::BindGroup,
    drift: wgpu::BindGroup,
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
        let (accelerate, drift) = (kernel("accelerate")?, kernel("drift")?);
        if setup.neighbours == Neighbours::Cells {
            let range = Range {
                groups: count.div_ceil(WORKGROUP),
                lists: None,
                accelerate: accelerate.bind(device, buffers)?,
                drift: drift.bind(device, buffers)?,
            };
            return Ok(Self {
                lists: None,
                ranges: vec![range],
                accelerate,
                drift,
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
        let mut first = 0;
        while first < count.max(1) {
            let end = first.saturating_add(longest).min(count.max(1));
            let groups = (end - first).div_ceil(WORKGROUP);
            let near = storage(device, "lists of neighbours", group * u64::from(groups));
            let range = uniform(device, "range of particles", 8);
            queue.write_buffer(&range, 0, bytemuck::cast_slice(&[first, end]));
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
                accelerate: accelerate.bind(device, &all)?,
                drift: drift.bind(device, &all)?,
            });
            first = end;
        }
        let gate = admit.bind(device, buffers)?;
        Ok(Self {
            lists: Some((lists, admit, gate)),
            accelerate,
            drift,
            ranges,
        })
    }

    /// Records the new velocities.
    pub fn record_accelerate(&self, pass: &mut wgpu::ComputePass<'_>) {
        if let Some((lists, admit, gate)) = &self.lists {
            for range in &self.ranges {
                if let Some(bound) = &range.lists {
                    lists.record(pass, bound, range.groups);
                }
            }
            admit.record(pass, gate, 1);
        }
        for range in &self.ranges {
            self.accelerate
                .record(pass, &range.accelerate, range.groups);
        }
    }

    /// Records the new densities and places.
    pub fn record_drift(&self, pass: &mut wgpu::ComputePass<'_>) {
        for range in &self.ranges {
            self.drift.record(pass, &range.drift, range.groups);
        }
    }
}
