//! GPU compute kernels for rock blocks in water.
//!
//! The data goes one way: [`scene`] → [`units`] → `lattice` → [`output`].

#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod checkpoint;
pub mod error;
pub mod formula;
pub mod kernel;
pub mod lattice;
pub mod layout;
pub mod link;
pub mod output;
pub mod readback;
pub mod scene;
pub mod simulation;
pub mod solid;
pub mod units;

pub use error::{Error, Result};
pub use wgpu;
