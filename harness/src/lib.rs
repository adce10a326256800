//! The parts of the `riprap` program that tests and examples use as well.

pub mod adapters;
pub mod bench;
mod broadphase;
pub mod check;
pub mod fingerprint;
pub mod migrate;
pub mod picture;
pub mod print;
pub mod records;
pub mod render;
pub mod report;
pub mod run;
pub mod schema;
pub mod stress;
pub mod threshold;
pub mod validate;

pub use kit::gpu;
