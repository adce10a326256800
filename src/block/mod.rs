//! Shapes of blocks.

mod cell;
mod compound;
mod from_half_spaces;
mod from_vertices;
mod half_space;
mod moments;
mod polyhedron;
mod shape;
mod solids;

pub use half_space::HalfSpace;
pub use polyhedron::Polyhedron;
pub use shape::{Form, Part, Shape};
