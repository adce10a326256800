//! What the `riprap` binary is made of.

pub mod gpu;
