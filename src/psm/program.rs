//! The WGSL files and constants of the kernels of blocks in the fluid.

use super::tiles::MAX_SEGMENT;
use crate::{
    gpu::link::Program,
    lattice::{Grid, Lattice, PsmAccess, SolidWeight, psm_storage},
};

/// Largest number of faces of a convex part: some adapters end loops after 65 535 iterations without an error, and a
/// cell that many faces cut takes four columns through all of them.
pub const MAX_FACES: u32 = 8192;

/// Storage buffers of the kernel with most of them, `reduce_faces`.
pub const MAX_STORAGE_BUFFERS: u32 = 8;

/// Added to a number in `work`: all of its cells are computed, as for new memory, not only those
/// that parts can reach.
pub const WHOLE: u32 = 1 << 31;

/// Mapping of invocations to the cells of a tile. Both give the same results, sums up to rounding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellMapping {
    /// One vector of invocations per tile, and sums by one invocation without barriers: for CPU adapters, which load the data
    /// of a tile again for each invocation.
    Serial,
    /// One invocation per cell, and sums by 64 invocations: for GPUs.
    Parallel,
}

/// Forms of the parts of blocks: kernels contain no code for other forms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Forms {
    /// Spheres.
    pub spheres: bool,
    /// Convex polyhedra.
    pub polyhedra: bool,
}

impl Forms {
    /// Both.
    pub const ALL: Self = Self {
        spheres: true,
        polyhedra: true,
    };

    /// The files of the slots for spheres and for polyhedra.
    fn files(self, sphere: &'static str, polyhedron: &'static str) -> [&'static str; 2] {
        [
            if self.spheres { sphere } else { "sphere_none" },
            if self.polyhedra {
                polyhedron
            } else {
                "polyhedron_none"
            },
        ]
    }
}

/// Number of workgroups that saturates a GPU.
const BUSY: u32 = 8192;
/// Number of invocations that a CPU adapter executes as one vector.
const VECTOR: u32 = 8;

impl CellMapping {
    /// Workgroups of `reduce_tiles` for a number of segments, and of `reduce_faces` for a number of jobs.
    pub fn groups(self, sums: u32) -> u32 {
        sums.div_ceil(self.segments_per_workgroup() as u32)
    }

    /// Segments of a workgroup of `reduce_tiles`.
    pub(super) fn segments_per_workgroup(self) -> usize {
        match self {
            Self::Serial => 64,
            Self::Parallel => 1,
        }
    }

    /// Tiles per segment, for `tiles` tiles in total.
    pub(super) fn segment(self, tiles: u32) -> u32 {
        match self {
            Self::Serial => 1,
            Self::Parallel => (tiles / BUSY).clamp(1, MAX_SEGMENT),
        }
    }
}

/// `voxelise`: one workgroup per tile of `work`. Binds `work`, `tiles`, `parts`, `faces`, `solid_fractions`, `edges`, whose
/// first word must be 0 before, and which is one word longer than `solid_fractions`.
pub fn voxelise(grid: &Grid, mapping: CellMapping, forms: Forms, weight: SolidWeight) -> Program {
    let [ball, hull] = forms.files("sphere_quick", "polyhedron_quick");
    mapped("voxelise", grid, mapping)
        .slot("effective", effective(weight))
        .slot("sphere_quick", ball)
        .slot("polyhedron_quick", hull)
}

/// `voxelise_edges`: computes the cells that `voxelise` has put into `edges`, by any number of workgroups. Binds `tiles`,
/// `parts`, `faces`, `solid_fractions`, `edges`.
pub fn voxelise_edges(grid: &Grid, forms: Forms, weight: SolidWeight) -> Program {
    let [ball, hull] = forms.files("sphere_fraction", "polyhedron_fraction");
    base("voxelise_edges", grid)
        .slot("effective", effective(weight))
        .slot("sphere_fraction", ball)
        .slot("polyhedron_fraction", hull)
}

fn effective(weight: SolidWeight) -> &'static str {
    match weight {
        SolidWeight::Exact => "effective_surface",
        SolidWeight::Standard => "effective_volume",
    }
}

/// c, cells², of a sphere of R cells, whose effective radius is R + c/R: fitted to the drag of a cubic array of
/// concentration 0.125, D = 5 and 10, and to the torque on a sphere of D = 8.
pub fn sphere_growth(weight: SolidWeight, tau: f64) -> f64 {
    let excess = tau - 0.5;
    match weight {
        SolidWeight::Exact => 1.0 / 12.0 + 0.4 * excess / (excess + 0.06),
        SolidWeight::Standard => 0.0,
    }
}

/// [`OBLIQUE_SHIFT`] with the exact weight; the standard one has no correction.
pub fn oblique_shift(weight: SolidWeight) -> f64 {
    match weight {
        SolidWeight::Exact => f64::from(super::tables::OBLIQUE_SHIFT),
        SolidWeight::Standard => 0.0,
    }
}

/// A program whose `psm_planes` have as many bindings as those of `lattice`; without this they have one binding.
pub(super) fn spread(program: Program, lattice: &Lattice) -> Program {
    let planes = lattice.bindings().psm_planes;
    program.text("psm_storage", psm_storage(planes, PsmAccess::Tiles))
}

/// `combine_parts`: one workgroup per lane of a brick with blocks, slot · lanes + lane, of `work`. Binds `work`, `tiles`,
/// `motions`, `lane_first`, `lane_tiles`, `solid_fractions`, `psm_planes_0`.
pub fn combine_parts(grid: &Grid, mapping: CellMapping) -> Program {
    mapped("combine_parts", grid, mapping)
}

/// `reduce_tiles`: [`CellMapping::groups`] workgroups. Binds `tiles`, `motions`, `solid_fractions`, `psm_planes_0`, `segments`,
/// and `partials`, [`super::WRENCH`] numbers per segment. A segment is a range of consecutive tiles of one block: the number
/// of the first + 2²⁸ · (their count - 1), or all bits for none.
pub fn reduce_tiles(grid: &Grid, mapping: CellMapping) -> Program {
    let file = match mapping {
        CellMapping::Serial => "tile_sum_serial",
        CellMapping::Parallel => "tile_sum_parallel",
    };
    base("reduce_tiles", grid).slot("tile_sum", file)
}

/// `reduce_blocks`: one workgroup per block. Binds `block_first`, the segments before each block and all, `partials`, `wrenches`.
pub fn reduce_blocks() -> Program {
    Program::new("reduce_blocks")
}

/// `reduce_faces`: [`CellMapping::groups`] workgroups. For each face it sums over [`super::FACE_LAYERS`] layers of cells along it, each one cell thick; the first
/// begins where cells no longer intersect its plane. A cell is fluid unless a wall, half of a solid or another block fills it; it is excluded if another part of
/// the same block lies over the face or fills part of the cell, or if another block fills less than half of it. The state is that at the beginning of the step. Binds `jobs` ([`super::FaceJob`], those of
/// a layer of a face in sequence), `tiles`, `parts`, `faces`, `motions`, `solid_fractions`, `psm_planes_0`, and
/// `face_partials`, [`super::FACE_LOAD`] numbers per job; in addition to [`constants`] it takes `VISCOSITY`. Spheres have no
/// faces.
pub fn reduce_faces(grid: &Grid, mapping: CellMapping) -> Program {
    let file = match mapping {
        CellMapping::Serial => "face_sum_serial",
        CellMapping::Parallel => "face_sum_parallel",
    };
    base("reduce_faces", grid).slot("face_sum", file)
}

/// `sum_faces`: one invocation per number of a layer of a face, 64 per workgroup. Binds `face_first` (jobs before each
/// layer, and all), `face_partials`, `face_loads`.
pub fn sum_faces() -> Program {
    Program::new("sum_faces")
}

/// The constants of all kernels that follow from the grid.
pub fn constants(grid: &Grid) -> Vec<(&'static str, f64)> {
    vec![
        ("BRICK_X", grid.brick[0].into()),
        ("BRICK_Y", grid.brick[1].into()),
        ("LANES_OF_ELEMENT", grid.lanes.into()),
    ]
}

fn base(entry: &str, grid: &Grid) -> Program {
    let cells = cells(grid);
    Program::new(entry)
        .text("workgroup", format!("const WORKGROUP = {cells}u;\n"))
        .text("psm_storage", psm_storage(1, PsmAccess::Tiles))
        .slot("lanes", "lanes_1")
}

/// The same of a kernel whose invocations share the cells of a tile.
fn mapped(entry: &str, grid: &Grid, mapping: CellMapping) -> Program {
    let cells = cells(grid);
    let invocations = match mapping {
        CellMapping::Serial => cells.min(VECTOR),
        CellMapping::Parallel => cells,
    };
    let text = format!("const WORKGROUP = {cells}u;\nconst INVOCATIONS = {invocations}u;\n");
    Program::new(entry)
        .text("workgroup", text)
        .text("psm_storage", psm_storage(1, PsmAccess::Tiles))
        .slot("lanes", "lanes_1")
}

fn cells(grid: &Grid) -> u32 {
    grid.brick.iter().product()
}
