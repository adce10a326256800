//! The lattice Boltzmann fluid: D3Q27, in place, on any device.

mod boundary;
mod bytes;
mod cell_kernels;
mod check;
mod exchange;
mod fluid;
mod gather;
mod geometry;
mod grid;
mod inside;
mod memory;
mod observe;
mod populations;
mod program;
mod setup;
mod stages;
mod start;
mod streams;
mod traffic;

pub use cell_kernels::{CellPass, OpenFace};
pub use exchange::Populations;
pub use fluid::{Lattice, face_name, in_plane};
pub use geometry::{C, FaceCell, Geometry, Link, MovingCell};
pub use grid::Grid;
pub use inside::Inside;
pub use memory::{Memory, bytes_a_population, memory};
pub use observe::{Derived, Fault, Observer, Sums};
pub use program::{BrickKind, collide_stream, constants, single_cells};
pub use setup::{Collision, Equilibrium, Face, Force, Rates, Setup, SolidOperator, Storage};
pub use stages::Stages;
pub use start::State;
pub use traffic::{bytes_a_cell, bytes_a_step};
