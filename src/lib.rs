//! GPU compute kernels for rock blocks in water, on any vendor's GPU through wgpu.
//!
//! The data goes one way, and so do the modules: [`scene`] (what the user wrote, SI) → [`units`]
//! (the border to lattice units) → [`lattice`] (the fluid on the device) → [`simulation`] (the
//! loop) → [`output`] (files). Below them, [`link`] makes one shader of the files in `kernels/`
//! and [`kernel`] binds and records it.
//!
//! Rock goes its own way through the host: [`block`] (shapes, and masses cut by joints) →
//! [`broadphase`] (which may touch; on the device, or on the host where they are few) → [`contact`]
//! (which do, and how) → [`law`] (what forces that gives) → [`integrate`] (where they go) →
//! [`bodies`] (all of it, a step) → [`safety`] (how far from moving).
//!
//! Where both meet, [`immersed`] has the cells of blocks in the lattice and what the fluid does to them, and [`coupling`]
//! what blocks make of that: buoyancy, inertia, joints, and the loop in which they move. Water with a free surface is
//! [`particles`], on the same blocks, and [`simulation::FreeSurface`] its loop. [`probe`] measures, [`checkpoint`] keeps a
//! state on disk, and [`guide`] has the equations of all of it with their sources.
//!
//! The caller owns device, queue and encoder; the library owns pipelines and buffers. It picks no
//! adapter, reads no environment, never blocks and does not panic on input.
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
//! let observer = Observer::new(&device, &lattice)?;
//!
//! let mut encoder = device.create_command_encoder(&Default::default());
//! {
//!     let mut pass = encoder.begin_compute_pass(&Default::default());
//!     for _ in 0..10 {
//!         lattice.record(&mut pass);
//!     }
//!     // Density and velocity, in buffers that your own kernels can bind.
//!     observer.record(&mut lattice, &mut pass)?;
//! }
//! queue.submit([encoder.finish()]);
//! assert_eq!(lattice.step(), 10);
//! # Ok(())
//! # }
//! ```

#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod block;
pub mod bodies;
pub mod broadphase;
pub mod checkpoint;
pub mod contact;
pub mod coupling;
pub mod error;
mod filled;
pub mod formula;
pub mod guide;
pub mod immersed;
pub mod integrate;
pub mod kernel;
pub mod lattice;
pub mod law;
pub mod layout;
pub mod link;
pub mod output;
pub mod particles;
pub mod probe;
pub mod readback;
pub mod safety;
pub mod scene;
pub mod search;
pub mod simulation;
pub mod solid;
pub mod timer;
pub mod units;
pub mod work;

pub use error::{Error, Result};

pub use glam;
pub use wgpu;

/// The README's examples, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;
