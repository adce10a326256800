//! The parts of the `riprap` program that tests and examples use as well.

pub mod gpu;
pub mod picture;
pub mod run;
