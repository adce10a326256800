//! Shapes of blocks.

mod polyhedron;

pub use polyhedron::{HalfSpace, Polyhedron};
