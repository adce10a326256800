//! The lattice Boltzmann fluid: D3Q27, in place, on any device.
//!
//! [`Setup`] has all parameters, in lattice units (Δx = Δt = 1, ρ₀ = 1); [`Units`](crate::units::Units)
//! converts. [`Lattice`] owns the populations and records steps into the caller's pass. [`Observer`] computes density, velocity and
//! derived fields, into buffers that kernels of the caller can bind. [`memory`] gives the memory of a setup before it is created.
//!
//! ```
//! use riprap::{lattice::{Face, Lattice, Observer, Setup, State, memory, Grid}, wgpu};
//!
//! # fn main() -> riprap::Result<()> {
//! // Any device; this one does nothing, so that the example runs everywhere.
//! let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
//!
//! // A channel of 32 × 16 × 16 cells between two walls, driven along x.
//! let cells = [32, 16, 16];
//! let mut setup = Setup::periodic(cells, 0.02);
//! setup.faces[2] = [Face::Wall([0.0; 3]), Face::Wall([0.0; 3])];
//! setup.force = riprap::lattice::Force::Constant([1e-5, 0.0, 0.0]);
//! let bytes = memory(&setup, &Grid::new(&setup)?, &device.limits())?;
//!
//! let mut lattice = Lattice::new(&device, setup)?;
//! lattice.start(&device, &queue, &State::rest(32 * 16 * 16), true)?;
//! let mut observer = Observer::new(&device, &lattice)?;
//! let mut encoder = device.create_command_encoder(&Default::default());
//! {
//!     let mut pass = encoder.begin_compute_pass(&Default::default());
//!     lattice.record(&mut pass);
//!     observer.record(&mut lattice, &mut pass)?;
//! }
//! queue.submit([encoder.finish()]);
//! assert_eq!(lattice.step(), 1);
//! # let _ = bytes;
//! # Ok(())
//! # }
//! ```

mod block_friction;
mod boundary;
mod buffers;
mod bytes;
mod cell_kernels;
mod check;
mod closed_joint;
mod directions;
mod exchange;
mod fluid;
mod force;
mod gather;
mod geometry;
mod grid;
mod inside;
mod memory;
mod observe;
mod populations;
mod program;
mod setup;
mod spread;
mod stages;
mod start;
mod statistics;
mod streams;
mod surface;
mod surface_columns;
mod surface_faces;
mod surface_friction;
mod survey;
mod synthetic_turbulence;
mod traffic;
mod wall_model;

pub use block_friction::{BlockFace, BlockFaces};
pub use cell_kernels::{CellPass, OpenFace};
pub use check::MAX_ROUGHNESS;
pub use directions::C;
pub use exchange::Populations;
pub use fluid::{Lattice, face_name, in_plane};
pub use geometry::{FaceCell, Geometry, LINKS_OF_ROW, Link, MovingCell};
pub use grid::Grid;
pub use inside::Inside;
pub use memory::{Memory, bytes_per_population, memory};
pub use observe::{Derived, Fault, Observer, Sums};
#[doc(hidden)]
pub use program::{BrickKind, collide_stream, constants, single_cells};
pub use setup::{
    Collision, Equilibrium, Face, Force, Rates, Setup, SolidOperator, SolidWeight, Storage,
    SurfaceCell, WallModel,
};
pub use spread::{Bindings, PSM_PLANES, STATISTICS_PLANES};
#[doc(hidden)]
pub use spread::{PsmAccess, psm_storage};
pub use stages::Stages;
pub use start::State;
pub use statistics::{Statistic, Statistics, StatisticsPass, StatisticsState};
pub use surface_faces::SurfaceFaces;
pub use synthetic_turbulence::{FaceMode, FourierMode, SyntheticTurbulence, TurbulentFace};
pub use traffic::{bytes_per_cell, bytes_per_step};
pub use wall_model::{WallCell, WallStress, Walls};
