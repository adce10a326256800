//! Comparison of the memory layout of a host struct with that of its WGSL counterpart.

use crate::{Error, Result};

/// Compares `T` with the struct `name` of a module: its size, and the offsets (bytes) of its fields, given with their WGSL
/// names in order.
///
/// ```
/// use riprap::gpu::{layout, link::Program};
/// #[repr(C)]
/// struct Cell { rho: f32, u: [f32; 3] }
/// let wgsl = "struct Cell { rho: f32, x: f32, y: f32, z: f32 }";
/// let linked = Program::new("cell").text("cell", wgsl).link()?;
/// let fields = [("rho", 0), ("x", 4), ("y", 8), ("z", 12)];
/// layout::check::<Cell>(&linked.module, "Cell", &fields)?;
/// # Ok::<(), riprap::Error>(())
/// ```
///
/// # Errors
/// [`Error::Layout`] with both layouts if they differ, or if there is no such struct.
pub fn check<T>(module: &naga::Module, name: &str, fields: &[(&str, usize)]) -> Result<()> {
    let wrong = |message| Error::Layout {
        structure: name.into(),
        message,
    };
    let found = module
        .types
        .iter()
        .find_map(|(_, found)| match &found.inner {
            naga::TypeInner::Struct { members, span } if found.name.as_deref() == Some(name) => {
                Some((members, *span))
            }
            _ => None,
        });
    let (members, span) = found.ok_or_else(|| wrong("the module has no such struct".into()))?;
    let there: Vec<_> = members
        .iter()
        .map(|m| (m.name.as_deref().unwrap_or_default(), m.offset as usize))
        .collect();
    if there == fields && span as usize == size_of::<T>() {
        return Ok(());
    }
    Err(wrong(format!(
        "it has {span} bytes and the fields {there:?} on the device, {} bytes and {fields:?} on the \
         host; change one of them",
        size_of::<T>()
    )))
}
