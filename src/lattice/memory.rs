//! What a fluid takes on a device, and over how many bindings it is spread.

use super::{
    Bindings, Face, Force, Grid, PSM_PLANES, STATISTICS_PLANES, Setup, Storage, populations::Q,
    surface, traffic,
};
use crate::{Error, Result, gpu::kernel::largest_binding};

/// Bytes and bindings of a fluid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Storage bindings of its fields.
    pub bindings: Bindings,
    /// Bytes of the populations.
    pub populations: u64,
    /// Bytes of everything else that stays on the device; what blocks leave in cells, 36 bytes each, comes as they reach them.
    pub others: u64,
    /// Bytes of the largest binding.
    pub largest_binding: u64,
    /// Storage bindings of the kernel that has the most.
    pub most_bindings: u32,
}

/// Bytes of a population in memory.
pub fn bytes_per_population(storage: Storage) -> u64 {
    match storage {
        Storage::F32 => 4,
        Storage::F16 => 2,
    }
}

/// A setup on a device.
struct Room<'a> {
    setup: &'a Setup,
    /// Bytes of a binding.
    binding: u64,
    /// Storage buffers of a kernel.
    buffers: u32,
}

impl Room<'_> {
    /// Bindings that fields with so many planes of so many bytes need; none if one does not hold a plane.
    fn bindings(&self, planes: u32, bytes: u64) -> Option<u32> {
        let each = (self.binding / bytes.max(1)).min(planes.into()) as u32;
        (each > 0).then(|| planes.div_ceil(each))
    }

    /// Bindings of the populations of so many scalars.
    fn populations(&self, scalars: u64) -> Option<u32> {
        // In 16 bits, too, scalars have an index of 32 bits.
        let bytes = scalars * bytes_per_population(self.setup.storage);
        let indexed = u64::from(u32::MAX) / scalars.max(1) * bytes;
        let least = Self {
            binding: self.binding.min(indexed),
            ..*self
        }
        .bindings(Q, bytes)?;
        match self.setup.bindings {
            Some(n) => (least <= n.clamp(1, Q)).then_some(n.clamp(1, Q)),
            None => Some(least),
        }
    }

    fn has_vectors(&self) -> bool {
        self.setup.wale.is_some() || self.has_force()
    }

    fn has_force(&self) -> bool {
        matches!(self.setup.force, Force::Field(_))
    }

    /// Bindings besides the populations, one of them for the planes of blocks, if each field of vectors has so many: of
    /// collide_stream, of a boundary pass, of macroscopic.
    fn others(&self, vectors: u32) -> u32 {
        let setup = self.setup;
        let moving = setup.faces.iter().flatten().any(|f| match f {
            Face::Wall(velocity) => *velocity != [0.0; 3],
            Face::Velocity(_) => true,
            _ => false,
        });
        let field = vectors * u32::from(self.has_force());
        let flags = u32::from(!setup.is_all_fluid());
        let step = field
            + 2 * flags
            + match (setup.wale, setup.wale_interval) {
                (None, _) => 0,
                (Some(_), 1) => 2 * vectors,
                (Some(_), _) => vectors + 1,
            }
            + u32::from(setup.max_speed > 0.0)
            + u32::from(setup.wall_model.is_some())
            + u32::from(setup.solid_operator.is_some())
            + u32::from(setup.has_block_friction())
            + 2 * u32::from(!setup.surface.is_empty());
        let boundary = match setup.wall_model {
            Some(_) => 4 + vectors + u32::from(setup.solid_operator.is_some()),
            None if moving => 2,
            None => flags,
        };
        step.max(boundary).max(4 + flags + field)
    }

    /// Bindings of a kernel besides the planes of blocks: of reduce_faces, of velocity_psm and list_block_faces; others have fewer.
    fn with_psm_planes(&self, vectors: u32) -> u32 {
        let reads_vectors = self.has_force() || self.setup.has_block_friction();
        7.max(5 + vectors * u32::from(reads_vectors))
    }

    /// How a grid of so many scalars, so many of them in bricks, is spread; none if the device does not hold it.
    fn spread(&self, scalars: u64, in_bricks: u64) -> Option<Bindings> {
        let vectors = match self.has_vectors() {
            true => self.bindings(3, 4 * scalars)?,
            false => 1,
        };
        self.bindings(1, 4 * scalars)?;
        let populations = self.populations(scalars)?;
        let left = self
            .buffers
            .checked_sub(populations + self.others(vectors))?;
        let psm_planes = match self.setup.solid_operator {
            // As if blocks reached all bricks. Where that is too many, fewer may be reached.
            Some(_) => self
                .bindings(PSM_PLANES, 4 * in_bricks)
                .unwrap_or(PSM_PLANES)
                .min(1 + left)
                .min(self.buffers.saturating_sub(self.with_psm_planes(vectors)))
                .max(1),
            None => 1,
        };
        Some(Bindings {
            populations,
            vectors,
            psm_planes,
            statistics: 0,
        })
    }

    /// The largest number of scalars that the device holds.
    fn most_scalars(&self) -> u64 {
        let (mut fits, mut too_many) = (0, u64::from(u32::MAX));
        while too_many - fits > 1 {
            let middle = fits.midpoint(too_many);
            match self.spread(middle, middle) {
                Some(_) => fits = middle,
                None => too_many = middle,
            }
        }
        fits
    }
}

/// Bindings of the sums of statistics over time, in kernels with so many others.
///
/// # Errors
/// [`Error::Limit`] if the device has too few for so many cells.
pub(super) fn statistics_bindings(
    setup: &Setup,
    grid: &Grid,
    limits: &wgpu::Limits,
    others: u32,
) -> Result<u32> {
    let room = Room {
        setup,
        binding: largest_binding(limits),
        buffers: limits.max_storage_buffers_per_shader_stage,
    };
    let plane = 4 * u64::from(grid.scalar_count());
    let wanted = room
        .bindings(STATISTICS_PLANES, plane)
        .unwrap_or(STATISTICS_PLANES);
    let (wants, has) = match others + wanted <= room.buffers {
        true if plane <= room.binding => return Ok(wanted),
        true => (plane, room.binding),
        false => ((others + wanted).into(), room.buffers.into()),
    };
    Err(Error::Limit {
        name: "storage buffers per shader stage, or bytes of one, for statistics over time".into(),
        wants,
        has,
        remedy: "use a larger cell, request no statistics of fields, or use another adapter".into(),
    })
}

/// The bytes that a fluid takes, spread so that the limits hold.
///
/// # Errors
/// [`Error::Limit`] that names the limit, and how many cells would fit if it is one of bytes.
pub fn memory(setup: &Setup, grid: &Grid, limits: &wgpu::Limits) -> Result<Memory> {
    let room = Room {
        setup,
        binding: largest_binding(limits),
        buffers: limits.max_storage_buffers_per_shader_stage,
    };
    let scalars = u64::from(grid.scalar_count());
    let direction = scalars * bytes_per_population(setup.storage);
    let (least, others) = (setup.bindings.map_or(1, |n| n.clamp(1, Q)), room.others(1));
    // A smaller grid mends neither of these.
    if least + others > room.buffers {
        let mut remedy = format!(
            "the populations take {least} of them and the rest of this setup {others}; open the device with a higher \
             `max_storage_buffers_per_shader_stage`, if its adapter has it"
        );
        if let Some(free) = room.buffers.checked_sub(others).filter(|&free| free > 0) {
            remedy += &format!(", or set `bindings` to at most {free}");
        }
        return Err(Error::Limit {
            name: "storage buffers per shader stage of this device".into(),
            wants: u64::from(least + others),
            has: room.buffers.into(),
            remedy,
        });
    }
    let padded = |a: usize| u64::from(grid.bricks()[a]) * u64::from(grid.brick[a]);
    let in_bricks = padded(0) * padded(1) * padded(2) * u64::from(grid.lanes);
    let Some(bindings) = room.spread(scalars, in_bricks) else {
        // Each plane has one binding, and of the populations as many as are free share one.
        let vectors = room.bindings(3, 4 * scalars).unwrap_or(3);
        let free = match room.has_vectors() {
            true => room.buffers.saturating_sub(room.others(vectors)),
            false => room.buffers - others,
        };
        let (what, wants) = match room.populations(scalars) {
            Some(wanted) if wanted <= free => ("a number in each cell".into(), 4 * scalars),
            _ => (
                format!("{free} of them free for the populations"),
                direction * u64::from(Q.div_ceil(least.max(free).clamp(1, Q))),
            ),
        };
        return Err(Error::Limit {
            name: format!("bytes of one storage binding ({what})"),
            wants,
            has: room.binding,
            remedy: format!(
                "the adapter holds about {} cells in one grid; use a larger cell, 16-bit storage, or another adapter",
                room.most_scalars()
            ),
        });
    };
    let Bindings {
        populations,
        vectors,
        psm_planes,
        ..
    } = bindings;
    let [slots, fractions] = surface::bytes(setup, grid);
    let others = [
        (!setup.surface.is_empty(), slots + fractions),
        (
            setup.wale.is_some(),
            traffic::bytes_of_wale(setup) * scalars,
        ),
        (!setup.is_all_fluid(), 4 * u64::from(grid.element_count())),
        (setup.wall_model.is_some(), 4 * scalars),
        (room.has_force(), 12 * scalars),
    ];
    let widest = match room.has_vectors() {
        true => 4 * scalars * u64::from(3_u32.div_ceil(vectors)),
        false => 4 * scalars,
    };
    let step = populations + room.others(vectors) + psm_planes - 1;
    let of_blocks = match setup.solid_operator {
        Some(_) => room.with_psm_planes(vectors) + psm_planes,
        None => 0,
    };
    Ok(Memory {
        bindings,
        populations: direction * u64::from(Q),
        others: others
            .iter()
            .filter(|(used, _)| *used)
            .map(|(_, bytes)| bytes)
            .sum(),
        largest_binding: (direction * u64::from(Q.div_ceil(populations)))
            .max(widest)
            .max(slots)
            .max(fractions),
        most_bindings: step.max(of_blocks),
    })
}
