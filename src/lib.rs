//! GPU compute kernels for rock blocks in water, on any vendor's GPU through wgpu.
//!
//! The modules follow the path of the data:
//!
//! | stage | module |
//! |---|---|
//! | a scene in SI units, from TOML | [`scene`], [`formula`] |
//! | conversion to lattice units | [`units`] |
//! | shapes, poses and loads; rock masses cut by joint sets | [`geometry`] |
//! | a fluid that fills its domain: D3Q27 lattice Boltzmann | [`lattice`] |
//! | blocks in that fluid: partially saturated cells | [`psm`] |
//! | water with a free surface: SPH | [`sph`] |
//! | motion of blocks: [`rock::broadphase`], [`rock::contact`], [`rock::law`], [`rock::integrate`] | [`rock`] |
//! | exchange between a fluid and blocks: buoyancy, added mass, joints | [`coupling`] |
//! | the loops, [probes](simulation::probe) and [checkpoints](simulation::checkpoint) | [`simulation`] |
//! | factors of safety of blocks | [`safety`] |
//! | VTK, CSV and sampled fields | [`output`] |
//!
//! [`prelude`] has the types that most programs use. [`gpu`] is below all of them: [`gpu::link`] makes one shader from the files in `kernels/`, and [`gpu::kernel`] binds and
//! records it. [`guide`] has the equations, with sources and limits.
//!
//! # Features
//!
//! All of them are on by default.
//!
//! | feature | modules that it compiles | crates that it adds |
//! |---|---|---|
//! | none | `lattice`, `psm`, `geometry`, `gpu`, `units`, `formula`, `output` | wgpu, naga, glam, bytemuck, thiserror |
//! | `rock` | `rock`, `safety`, rock masses in `geometry` | clarabel, rayon |
//! | `sph` | `sph`; implies `rock` | |
//! | `scene` | `scene`; `scene::build` to the setups of the other features | serde, toml, schemars, strsim |
//! | `rock`, `sph` and `scene` | `coupling`, `simulation` | |
//! | `checkpoint` | files of `simulation::checkpoint`; implies `rock`, `sph` and `scene` | serde, postcard, crc32fast |
//! | `mesh` | files in `geometry`: STL, OBJ; terrain | stl_io, tobj, tiff |
//! | `backends` | the backends of wgpu: Vulkan, OpenGL ES, Metal, DirectX 12 | those of wgpu |
//!
//! # Devices
//!
//! The caller owns device, queue and encoder; the library owns pipelines and buffers. It chooses no
//! adapter, reads no environment, does not block, and does not panic on input.
//!
//! ```
//! use riprap::{lattice::{Lattice, Observer, Setup, State}, wgpu};
//!
//! # fn main() -> riprap::Result<()> {
//! // Any device; this one does nothing, so that the example runs everywhere.
//! let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
//!
//! // A periodic box of 16³ cells with the lattice viscosity 0.01.
//! let mut lattice = Lattice::new(&device, Setup::periodic([16, 16, 16], 0.01))?;
//! lattice.start(&device, &queue, &State::rest(16 * 16 * 16), true)?;
//! let mut observer = Observer::new(&device, &lattice)?;
//!
//! let mut encoder = device.create_command_encoder(&Default::default());
//! {
//!     let mut pass = encoder.begin_compute_pass(&Default::default());
//!     for _ in 0..10 {
//!         lattice.record(&mut pass);
//!     }
//!     // Density and velocity, in buffers that your kernels can bind.
//!     observer.record(&mut lattice, &mut pass)?;
//! }
//! queue.submit([encoder.finish()]);
//! assert_eq!(lattice.step(), 10);
//! # Ok(())
//! # }
//! ```

#![forbid(unsafe_code)]
#![deny(missing_docs)]
// Modules share helpers with those that a feature leaves out; the build with all of them says which are unused.
#![cfg_attr(
    not(all(feature = "checkpoint", feature = "mesh")),
    allow(dead_code, unused_imports)
)]

#[cfg(all(feature = "rock", feature = "sph", feature = "scene"))]
pub mod coupling;
pub mod error;
pub mod formula;
pub mod geometry;
pub mod gpu;
pub mod guide;
pub mod lattice;
pub mod output;
pub mod prelude;
pub mod psm;
mod random;
#[cfg(feature = "rock")]
pub mod rock;
#[cfg(feature = "rock")]
pub mod safety;
#[cfg(feature = "scene")]
pub mod scene;
#[cfg(all(feature = "rock", feature = "sph", feature = "scene"))]
pub mod simulation;
#[cfg(feature = "sph")]
pub mod sph;
pub mod units;

pub use error::{Error, Result};

pub use glam;
pub use wgpu;

/// The examples of the README, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;

/// The examples of the book, compiled.
#[cfg(all(doctest, feature = "rock"))]
#[doc = include_str!("../docs/src/embedding.md")]
pub struct Embedding;
