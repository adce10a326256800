//! Fields of several planes, one value per cell in each plane, distributed over the bindings of a device, and the WGSL
//! that accesses the planes.

use std::fmt::Write;

/// Number of bindings of each field of a fluid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bindings {
    /// Of the populations, [`super::C`] planes.
    pub populations: u32,
    /// Of each field of vectors, 3 planes: the velocity of a step, the body force.
    pub vectors: u32,
    /// Of the fields of blocks, [`PSM_PLANES`] planes.
    pub psm_planes: u32,
    /// Of the sums of statistics over time, [`STATISTICS_PLANES`] planes; 0 without statistics.
    pub statistics: u32,
}

/// The given number of bindings for the populations, and one for each other field.
impl From<u32> for Bindings {
    fn from(populations: u32) -> Self {
        Self {
            populations,
            vectors: 1,
            psm_planes: 1,
            statistics: 0,
        }
    }
}

/// Number of values per cell of a brick with blocks.
pub const PSM_PLANES: u32 = 10;

/// Numbers per cell of statistics over time: 4 means, 7 covariances, and for the open block 4 sums and 7 sums of products.
pub const STATISTICS_PLANES: u32 = 22;

/// Names of the bindings of the planes of blocks.
pub(super) const PSM_NAMES: [&str; PSM_PLANES as usize] = [
    "psm_planes_0",
    "psm_planes_1",
    "psm_planes_2",
    "psm_planes_3",
    "psm_planes_4",
    "psm_planes_5",
    "psm_planes_6",
    "psm_planes_7",
    "psm_planes_8",
    "psm_planes_9",
];

/// Planes per binding for a number of bindings: the same in each but the last.
pub(super) fn planes(count: u32, bindings: u32) -> Vec<std::ops::Range<u32>> {
    let each = count.div_ceil(bindings.clamp(1, count));
    let starts = (0..count).step_by(each as usize);
    starts.map(|s| s..count.min(s + each)).collect()
}

/// A field, and the shader functions that access it.
pub(super) struct Field<'a> {
    /// Name of its bindings, which are numbered from 0.
    pub name: &'a str,
    /// Number of the first binding.
    pub binding: u32,
    /// Type of an element.
    pub word: &'a str,
    /// Parameters of the functions that read and write, after the plane s.
    pub parameters: &'a str,
    /// Name of the function that reads; none: there is none.
    pub read: Option<&'a str>,
    /// Name of the function that writes; none: there is none.
    pub write: Option<&'a str>,
}

impl Field<'_> {
    /// Bindings and functions; `at` gives the place in a binding that has these planes.
    ///
    /// After inlining s is a literal, so that of the chain of comparisons one access is left.
    pub fn text(
        &self,
        planes: &[std::ops::Range<u32>],
        at: impl Fn(&std::ops::Range<u32>) -> String,
    ) -> String {
        let Self {
            name,
            word,
            parameters,
            ..
        } = self;
        let access = if self.write.is_some() {
            "read_write"
        } else {
            "read"
        };
        let (mut text, mut get, mut put) = (String::new(), String::new(), String::new());
        for (n, own) in (0..).zip(planes) {
            let binding = self.binding + n;
            let _ = writeln!(
                text,
                "@group(0) @binding({binding}) var<storage, {access}> {name}_{n}: array<{word}>;"
            );
            let place = format!("{name}_{n}[{}]", at(own));
            if n as usize + 1 < planes.len() {
                let end = own.end;
                let _ = writeln!(get, "    if (s < {end}u) {{ return {place}; }}");
                let _ = writeln!(put, "    if (s < {end}u) {{ {place} = word; return; }}");
            } else {
                let _ = writeln!(get, "    return {place};");
                let _ = writeln!(put, "    {place} = word;");
            }
        }
        if let Some(read) = self.read {
            let _ = write!(
                text,
                "fn {read}(s: u32, {parameters}) -> {word} {{\n{get}}}\n"
            );
        }
        if let Some(write) = self.write {
            let _ = write!(
                text,
                "fn {write}(s: u32, {parameters}, word: {word}) {{\n{put}}}\n"
            );
        }
        text
    }
}

/// `read_before(s, e)` and `write_after(s, e, word)`: component s of the velocity of the step before and of this one, of
/// element e. A step either reads or writes if the eddy viscosity is evaluated every second step, in one field.
pub(super) fn velocities(bindings: u32, wale_interval: u32) -> String {
    let write_after = Some("write_after");
    let before = Field {
        name: "velocity_before",
        binding: 60,
        word: "Reals",
        parameters: "e: u32",
        read: Some("read_before"),
        write: write_after.filter(|_| wale_interval == 2),
    };
    let after = Field {
        name: "velocity_after",
        binding: 63,
        read: None,
        write: write_after,
        ..before
    };
    let text = |field: Field<'_>| field.text(&planes(3, bindings), |own| vector(own, ELEMENTS));
    let second = match wale_interval {
        1 => text(after),
        _ => String::new(),
    };
    format!("// needs grid, $reals\n{}{second}", text(before))
}

/// `read_velocity(s, n)`: component s of the velocity of the step before, of cell n.
pub(super) fn cell_velocities(bindings: u32) -> String {
    let field = Field {
        name: "velocity_before",
        binding: 60,
        word: "f32",
        parameters: "e: u32",
        read: Some("read_velocity"),
        write: None,
    };
    let text = field.text(&planes(3, bindings), |own| vector(own, SCALARS));
    format!("// needs scalar_grid\n{text}")
}

/// `read_force(s, n)`: component s of the force field, of an element or, with `scalars`, of a cell.
pub(super) fn forces(bindings: u32, scalars: bool) -> String {
    let (word, count, needs) = match scalars {
        true => ("f32", SCALARS, "scalar_grid"),
        false => ("Reals", ELEMENTS, "grid, $reals"),
    };
    let field = Field {
        name: "force_field",
        binding: 66,
        word,
        parameters: "e: u32",
        read: Some("read_force"),
        write: None,
    };
    let text = field.text(&planes(3, bindings), |own| vector(own, count));
    format!("// needs {needs}\n{text}")
}

/// `read_statistic(s, e)` and `set_statistic(s, e, word)`: plane s of the statistics over time, of an element or, with
/// `scalars`, of a cell.
pub(super) fn statistics(bindings: u32, scalars: bool) -> String {
    let (count, needs) = match scalars {
        true => (SCALARS, "scalar_grid, $reals"),
        false => (ELEMENTS, "grid, $reals"),
    };
    let field = Field {
        name: STATISTICS_NAME,
        binding: 80,
        word: "Reals",
        parameters: "e: u32",
        read: Some("read_statistic"),
        write: Some("set_statistic"),
    };
    let text = field.text(&planes(STATISTICS_PLANES, bindings), |own| {
        vector(own, count)
    });
    format!("// needs {needs}\n{text}")
}

/// Name of the bindings of statistics, which are numbered from 0.
pub(super) const STATISTICS_NAME: &str = "statistics";

/// Elements of the grid, and its scalars.
pub(super) const ELEMENTS: &str = "NX * NY * NZ";
pub(super) const SCALARS: &str = "NX * NY * NZ * LANES_OF_ELEMENT";

/// The place of element e in plane s, where each has `count`.
pub(super) fn vector(own: &std::ops::Range<u32>, count: &str) -> String {
    format!("(s - {}u) * ({count}) + e", own.start)
}

/// Kernels that access the planes of partially saturated cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PsmAccess {
    /// The fluid kernel, by elements.
    Elements,
    /// A kernel of tiles, by cells.
    Tiles,
    /// A kernel of output, by cells.
    Cells,
    /// A kernel for single cells that writes some of them.
    WrittenCells,
}

/// `read_psm(s, slot, e)` and `write_psm(s, slot, e, word)`: plane s of the brick `slot`, at its element or cell e.
pub fn psm_storage(bindings: u32, access: PsmAccess) -> String {
    let (word, stride, needs) = match access {
        PsmAccess::Elements => ("Reals", "WORKGROUP", "// needs workgroup, $reals\n"),
        PsmAccess::Tiles => (
            "f32",
            "(WORKGROUP * LANES_OF_ELEMENT)",
            "// needs workgroup\n",
        ),
        PsmAccess::Cells | PsmAccess::WrittenCells => (
            "f32",
            "(BRICK_X * BRICK_Y * BRICK_Z * LANES_OF_ELEMENT)",
            "",
        ),
    };
    let field = Field {
        name: "psm_planes",
        binding: 70,
        word,
        parameters: "slot: u32, e: u32",
        read: Some("read_psm"),
        write: (access != PsmAccess::Cells).then_some("write_psm"),
    };
    let text = field.text(&planes(PSM_PLANES, bindings), |own| {
        let count = own.len();
        format!(
            "slot * ({count}u * {stride}) + (s - {}u) * {stride} + e",
            own.start
        )
    });
    format!("{needs}{text}")
}
