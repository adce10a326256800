//! Free-surface water by smoothed particle hydrodynamics (SPH), with walls and blocks in it.
//!
//! The host generates the initial particles ([`fill`], [`boundary_particles`]): fluid particles start on a lattice of
//! spacing Δx. Walls and blocks carry *boundary* (dummy) particles inside, in as many layers as the support of the
//! kernel reaches, the first layer Δx/2 below the surface (Adami, Hu & Adams 2012, J. Comput. Phys. 231:7057). The
//! support of a fluid particle near a wall is therefore as full as in the interior of the fluid. The device then
//! advances the particles ([`SphSolver`]).
//!
//! ```
//! use glam::DVec3;
//! use riprap::{sph::{Setup, SphSolver}, wgpu};
//!
//! # fn main() -> riprap::Result<()> {
//! // Any device; this one does nothing, so that the example runs everywhere.
//! let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
//!
//! // Water 0.4 m deep in a tank of 1 m, with particles every 0.1 m and a speed of sound of 28 m/s.
//! let setup = Setup::tank(DVec3::ONE, 0.1, 28.0);
//! let at = |i: u32, j: u32, k: u32| (DVec3::new(i.into(), j.into(), k.into()) + 0.5) * 0.1;
//! let layer = |k: u32| (0..100).map(move |n| at(n % 10, n / 10, k));
//! let positions: Vec<DVec3> = (0..4).flat_map(layer).collect();
//! let pressures: Vec<f64> = positions.iter().map(|x| 9810.0 * (0.4 - x.z)).collect();
//! let still = vec![DVec3::ZERO; positions.len()];
//! let mut water = SphSolver::new(&device, &queue, setup, &positions, &still, &pressures)?;
//!
//! // A hundredth of a second, of which one step is recorded.
//! water.begin(&queue, &[], 0.01)?;
//! let mut encoder = device.create_command_encoder(&Default::default());
//! water.record(&mut encoder);
//! queue.submit([encoder.finish()]);
//! assert_eq!(water.counts().fluid, 400);
//! # Ok(())
//! # }
//! ```

mod bodies;
mod boundary_particles;
mod cell_grid;
mod fill;
mod kernels;
mod layer_polygon;
mod layout;
mod neighbour_lists;
mod particle_lattice;
mod probes;
mod program;
mod setup;
mod solid;
mod solver;
mod speed_estimate;
mod water;

pub use bodies::bodies;
pub use boundary_particles::boundary_particles;
pub use cell_grid::CellGrid;
pub use fill::{Start, WaterBody, fill, water_volume};
pub use kernels::Counts;
pub use layout::{BodyMotion, Clock, Hull, Particle, ReferencePosition, WallWork};
#[doc(hidden)]
pub use neighbour_lists::{CountingSort, SortedParticles};
pub use particle_lattice::ParticleLattice;
pub use probes::Interpolator;
#[doc(hidden)]
pub use program::{KERNELS, MAX_STORAGE_BUFFERS, constants, kernels_of, program};
pub use setup::{Body, EquationOfState, NeighbourSearch, Scheme, Setup, Side, Wendland};
pub(crate) use solid::{ConvexPart, is_reached};
pub use solid::{Faces, Solid};
pub use solver::{ExchangeResult, ExternalWork, SphSolver, SphState};
pub use speed_estimate::SpeedEstimate;
pub use water::{Totals, Water};
