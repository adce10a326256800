//! Blocks in the fluid as partially saturated cells (Noble & Torczynski 1998; Gardner & Sitar 2018).
//!
//! Every cell that a block reaches has a solid fraction and a velocity of the solid. The
//! fluid kernel weights its collision with the fraction, and the reaction, summed over the cells, is the load on
//! the block. The device works on tiles: the part of one convex part of a block in one lane of one brick,
//! which is what a workgroup of the fluid kernel runs.
//!
//! 1. `voxelise` and `voxelise_edges` write the solid fraction of one part in each cell of a tile,
//! 2. `combine_parts` adds the parts that share a cell,
//! 3. the fluid kernel collides and stores the action of each cell on the solid in it,
//! 4. `reduce_tiles` and `reduce_blocks` sum it to the load on each block, in a fixed order;
//! 5. if loads on single faces are requested, `reduce_faces` and `sum_faces` sum the tractions of the fluid in two layers of
//!    cells along them. The force on cells inside the solid belongs to no face: full cells reflect the populations
//!    that they contained when they were covered, and this cancels only over the whole block.
//!
//! ```
//! use glam::{DQuat, DVec3};
//! use riprap::{
//!     geometry::{Pose, Shape},
//!     lattice::{Lattice, Setup, SolidOperator},
//!     psm::{Frame, SolidBlock, SolidCells},
//!     units::Units,
//!     wgpu,
//! };
//!
//! # fn main() -> riprap::Result<()> {
//! // Any device; this one does nothing, so that the example runs everywhere.
//! let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
//! let mut setup = Setup::periodic([16; 3], 0.01);
//! setup.solid_operator = Some(SolidOperator::Holdych);
//! let mut lattice = Lattice::new(&device, setup)?;
//!
//! // A ball of 6 cm in a fluid whose cells are 1 cm wide.
//! let units = Units { cell: 0.01, time_step: 0.001, density: 1000.0 };
//! let frame = Frame { origin: DVec3::ZERO, units };
//! let shape = Shape::sphere(0.03)?.into();
//! let ball = SolidBlock::new(shape);
//! let mut cells = SolidCells::new(&device, &lattice, frame, vec![ball])?;
//!
//! // A step: where the ball is, its cells, the bricks with them, the load, all other bricks.
//! let pose = Pose::rigid(DVec3::splat(0.08), DQuat::IDENTITY, DVec3::X * 0.1, DVec3::ZERO);
//! cells.place(&device, &queue, &mut lattice, &[pose])?;
//! let mut encoder = device.create_command_encoder(&Default::default());
//! {
//!     let mut pass = encoder.begin_compute_pass(&Default::default());
//!     cells.record_cells(&mut pass);
//!     lattice.record_psm(&mut pass);
//!     cells.record_loads(&mut pass);
//!     lattice.record_rest(&mut pass);
//! }
//! queue.submit([encoder.finish()]);
//!
//! // What was read of `cells.wrenches()`, as forces and moments in SI.
//! let wrenches = vec![0.0; cells.wrench_count()];
//! assert_eq!(cells.loads(&wrenches)?[0].force, DVec3::ZERO);
//! # Ok(())
//! # }
//! ```

mod face_load;
mod face_sums;
mod frame;
mod kernels;
mod load;
mod near_cells;
mod program;
mod solid_cells;
mod tables;
mod tiles;

pub use face_load::FaceLoad;
pub use frame::{Frame, spin};
pub use near_cells::NearCell;
pub(crate) use near_cells::{near_cells, outline};
#[doc(hidden)]
pub use program::{
    CellMapping, Forms, MAX_FACES, MAX_STORAGE_BUFFERS, WHOLE, combine_parts, constants,
    reduce_blocks, reduce_faces, reduce_tiles, sum_faces, voxelise, voxelise_edges,
};
pub(crate) use program::{oblique_shift, sphere_growth};
pub use solid_cells::{CellWork, SolidBlock, SolidCells};
#[doc(hidden)]
pub use tables::{
    FACE_LAYERS, FACE_LOAD, FACING_SUM, FaceJob, INTERIOR, INTERIOR_SUM, JOINT_SUM, Motion, NEAR,
    OBLIQUE_SHIFT, PLANES, Part, SHARED_SUM, TOUCHES, Tile, WRENCH,
};

use tiles::Plan;
