//! Data of blocks for the device, with the layout of `kernels/psm/tables.wgsl`, in lattice
//! units.

use bytemuck::{Pod, Zeroable};

/// Outward shift, cells, of the effective position of a plane with the unit normal n, over 1 − (n_x⁴ + n_y⁴ + n_z⁴): with the
/// exact weight alone, planes at an angle to the grid lie inside by about as much (docs/src/theory/solids.md).
pub const OBLIQUE_SHIFT: f32 = 0.05;

/// Solid fraction of a part in a cell that is inside it, as are all cells within two layers around.
pub const INTERIOR: f32 = 2.0;

/// Marks a cell that a part leaves empty, if it does not leave all of the 26 neighbours empty.
pub const NEAR: f32 = -1.0;

/// The same of a cell whose side lies on a face of the part.
pub const TOUCHES: f32 = -2.0;

/// Added to the sum of the solid fractions in a cell in the interior of one of its parts.
pub const INTERIOR_SUM: f32 = 8.0;

/// Added to it in a full cell of a closed joint, in which several blocks meet.
pub const JOINT_SUM: f32 = 16.0;

/// Used instead if one block fills the cell, and another one the next cell.
pub const FACING_SUM: f32 = 24.0;

/// Used instead of both in cells that are less full.
pub const SHARED_SUM: f32 = 32.0;

/// Number of values per cell of a brick with blocks.
pub const PLANES: usize = crate::lattice::PSM_PLANES as usize;

/// Number of sums per block.
pub const WRENCH: usize = 20;

/// Layers of cells along a face over which its load is summed.
pub const FACE_LAYERS: usize = 2;

/// Number of sums per layer of cells along a requested face: traction
/// (3), its moment about the block's centroid (3), height of the cells' centres over the face, their feet on the face
/// from that centroid (3) and the products of these (xx, yy, zz, yz, zx, xy), number of cells with fluid, number of
/// cells.
pub const FACE_LOAD: usize = 18;

/// The part of one convex part of a block in one lane of one brick with blocks.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Tile {
    /// Its lowest cell, shifted by whole periods of the domain to be next to the part.
    pub cell: [i32; 3],
    /// Number of the convex part.
    pub part: u32,
    /// Number of the block.
    pub block: u32,
    /// Number of the brick among the bricks with blocks.
    pub slot: u32,
    /// Lane of the brick's elements.
    pub lane: u32,
    /// Number of cells in the domain along each axis, from the lowest cell ([`Tile::pack`]), and the range that the part can reach
    /// ([`Tile::reaching`]).
    pub inside: u32,
}

impl Tile {
    /// Number of ranges of equal size, except for the last ones, into which the cells of a tile are divided, in the order of the workgroup.
    pub const EIGHTHS: u32 = 8;

    /// Packs the numbers of cells along each axis, at most 255, into one word; the part can reach all of them.
    pub const fn pack([x, y, z]: [u32; 3]) -> u32 {
        x | y << 8 | z << 16 | Self::EIGHTHS << 28
    }

    /// The same for a part that can reach only the eighths from `first` up to `end`.
    #[must_use]
    pub const fn reaching(self, [first, end]: [u32; 2]) -> Self {
        let inside = self.inside & 0xff_ffff | first << 24 | end << 28;
        Self { inside, ..self }
    }
}

/// Position of a convex part. Its centroid is at `base` + `fraction` (cells), 0 ≤ `fraction` < 1, so that
/// the distance of a cell from `base` is exact.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Part {
    /// Whole cells of the centroid.
    pub base: [i32; 3],
    /// Its first face in the list of all: outward unit normal, and distance from the centroid (cells).
    pub first_face: u32,
    /// Rest of the centroid, cells.
    pub fraction: [f32; 3],
    /// Number of faces; 0: a sphere.
    pub faces: u32,
    /// Lower corner of the bounding box from the centroid, cells.
    pub low: [f32; 3],
    /// Radius of a sphere, cells.
    pub radius: f32,
    /// Upper corner of the bounding box from the centroid, cells.
    pub high: [f32; 3],
    /// Number of the block that it belongs to.
    pub block: u32,
}

/// Motion of a block. Its material at r (cells) from the centroid has the velocity `velocity` +
/// `gradient_x` r.x + `gradient_y` r.y + `gradient_z` r.z.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Motion {
    /// Whole cells of the centroid.
    pub base: [i32; 3],
    /// Padding.
    pub pad0: u32,
    /// Rest of the centroid, cells.
    pub fraction: [f32; 3],
    /// Padding.
    pub pad1: u32,
    /// Velocity of the centroid, cells per step.
    pub velocity: [f32; 3],
    /// Padding.
    pub pad2: u32,
    /// Change of the velocity along x, per step.
    pub gradient_x: [f32; 3],
    /// Padding.
    pub pad3: u32,
    /// Change of the velocity along y, per step.
    pub gradient_y: [f32; 3],
    /// Padding.
    pub pad4: u32,
    /// Change of the velocity along z, per step.
    pub gradient_z: [f32; 3],
    /// Padding.
    pub pad5: u32,
}

/// A job of `reduce_faces`: a layer of cells along a face, in a tile.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct FaceJob {
    /// Number of the tile.
    pub tile: u32,
    /// Number of the face in the tile's part.
    pub face: u32,
    /// Layer of cells along the face, below [`FACE_LAYERS`].
    pub layer: u32,
}
