//! What a fluid takes on a device, and over how many bindings it is spread.

use super::{Face, Force, Grid, Setup, Storage, populations::Q};
use crate::{Error, Result};

/// Bytes and bindings of a fluid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Storage bindings of the populations.
    pub bindings: u32,
    /// Bytes of the populations.
    pub populations: u64,
    /// Bytes of everything else that stays on the device.
    pub others: u64,
    /// Bytes of the largest binding.
    pub largest_binding: u64,
    /// Storage bindings of the kernel that has the most.
    pub most_bindings: u32,
}

/// Bytes of a population in memory.
pub fn bytes_a_population(storage: Storage) -> u64 {
    match storage {
        Storage::F32 => 4,
        Storage::F16 => 2,
    }
}

/// The bytes that a fluid takes, spread so that the limits hold.
///
/// # Errors
/// [`Error::Limit`] that names the limit, and how many cells would fit if it is one of bytes.
pub fn memory(setup: &Setup, grid: &Grid, limits: &wgpu::Limits) -> Result<Memory> {
    let scalars = u64::from(grid.element_count()) * u64::from(grid.lanes);
    let direction = scalars * bytes_a_population(setup.storage);
    let binding_limit = limits
        .max_storage_buffer_binding_size
        .min(limits.max_buffer_size);
    let fluid = setup.is_all_fluid();
    let moving = setup.faces.iter().flatten().any(|f| match f {
        Face::Wall(velocity) => *velocity != [0.0; 3],
        Face::Velocity(_) => true,
        _ => false,
    });
    // Bindings besides the populations: of collide_stream, of a boundary pass, of macroscopic.
    let field = u32::from(matches!(setup.force, Force::Field(_)));
    let flags = u32::from(!fluid);
    let step = field
        + 2 * flags
        + 2 * u32::from(setup.wale.is_some())
        + u32::from(setup.max_speed > 0.0)
        + u32::from(setup.solid_operator.is_some());
    let boundary = if moving { 2 } else { flags };
    let other_bindings = step.max(boundary).max(4 + flags + field);
    let free = limits
        .max_storage_buffers_per_shader_stage
        .saturating_sub(other_bindings);
    let each = (binding_limit / direction.max(1)).min(Q.into()) as u32;
    let wanted = match setup.bindings {
        Some(n) => n.clamp(1, Q),
        None if each == 0 => Q,
        None => Q.div_ceil(each),
    };
    // A smaller grid mends neither of these.
    if free == 0 || setup.bindings.is_some() && wanted > free {
        let least = setup.bindings.map_or(1, |_| wanted);
        let mut remedy = format!(
            "the populations take {least} of them and the rest of this setup {other_bindings}; open the device with a higher \
             `max_storage_buffers_per_shader_stage`, if its adapter has it"
        );
        if wanted > free && free > 0 {
            remedy += &format!(", or set `bindings` to at most {free}");
        }
        return Err(Error::Limit {
            name: "storage buffers a shader stage of this device".into(),
            wants: u64::from(least + other_bindings),
            has: limits.max_storage_buffers_per_shader_stage.into(),
            remedy,
        });
    }
    // Of what is not populations, the vectors of a field have one binding, and each result has one.
    let vectors = setup.wale.is_some() || field == 1;
    let widest = if vectors { 12 } else { 4 };
    let spread = each > 0 && wanted <= free && Q.div_ceil(wanted) <= each;
    if !spread || widest * scalars > binding_limit {
        // The largest number of directions a binding that the free bindings leave.
        let fit = binding_limit / u64::from(Q.div_ceil(free.clamp(1, Q)));
        let fit = (fit / bytes_a_population(setup.storage)).min(binding_limit / widest);
        let (what, wants) = match (spread, vectors) {
            (false, _) => (
                format!("{free} of them free for the populations"),
                direction * u64::from(Q.div_ceil(wanted.min(free).max(1))),
            ),
            (true, true) => ("a vector in each cell".into(), widest * scalars),
            (true, false) => ("a number in each cell".into(), widest * scalars),
        };
        return Err(Error::Limit {
            name: format!("bytes of one storage binding ({what})"),
            wants,
            has: binding_limit,
            remedy: format!(
                "the adapter holds about {fit} cells in one grid; use a larger cell, 16-bit storage, \
                 or another adapter"
            ),
        });
    }
    let others = [
        (setup.wale.is_some(), 24 * scalars),
        (!fluid, 4 * u64::from(grid.element_count())),
        (field == 1, 12 * scalars),
    ];
    Ok(Memory {
        bindings: wanted,
        populations: direction * u64::from(Q),
        others: others
            .iter()
            .filter(|(used, _)| *used)
            .map(|(_, bytes)| bytes)
            .sum(),
        largest_binding: (direction * u64::from(Q.div_ceil(wanted))).max(widest * scalars),
        most_bindings: wanted + other_bindings,
    })
}
