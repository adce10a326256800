//! Shapes of blocks.

mod cell;
mod compass;
mod compound;
mod convex_parts;
mod from_half_spaces;
mod from_mesh;
mod from_vertices;
mod half_space;
mod joint_set;
mod moments;
mod overlap;
mod polygons;
mod polyhedron;
mod random;
mod rock_mass;
mod settle;
mod shape;
mod solids;

pub use compass::Compass;
pub use half_space::HalfSpace;
pub use joint_set::{JointSet, Persistence, Scatter};
pub use polyhedron::Polyhedron;
pub use rock_mass::{Fragment, Fragments, RockMass, Sliver};
pub use shape::{Form, Part, Shape};
