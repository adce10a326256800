//! Shapes of blocks: convex polyhedra, compounds, spheres, and, with the feature `rock`, rock masses cut by joints.
//!
//! ```
//! use glam::DVec3;
//! use riprap::geometry::Polyhedron;
//!
//! # fn main() -> riprap::Result<()> {
//! // A wedge from its corners; its centroid becomes the origin.
//! let (wedge, centre) = Polyhedron::from_vertices(&[
//!     DVec3::ZERO,
//!     DVec3::new(2.0, 0.0, 0.0),
//!     DVec3::new(0.0, 1.0, 0.0),
//!     DVec3::new(0.0, 0.0, 1.0),
//! ])?;
//! assert!((wedge.volume() - 1.0 / 3.0).abs() < 1e-15);
//! assert!(centre.distance(DVec3::new(0.5, 0.25, 0.25)) < 1e-15);
//! # Ok(())
//! # }
//! ```

mod cell;
mod closed;
mod compass;
mod compound;
mod convex_parts;
mod from_half_spaces;
mod from_mesh;
mod from_vertices;
mod half_space;
mod joint_set;
mod mesh;
#[cfg(feature = "mesh")]
mod mesh_file;
mod moments;
mod overlap;
mod placed;
mod polygons;
mod polyhedron;
mod pose;
mod random;
#[cfg(feature = "rock")]
mod rock_mass;
mod settle;
mod shape;
mod solids;
mod winding;

pub use compass::Compass;
pub use half_space::HalfSpace;
pub use joint_set::{JointSet, Persistence, Scatter};
pub use mesh::TriangleMesh;
pub use placed::Placed;
pub(crate) use placed::clip;
pub use polyhedron::Polyhedron;
pub use pose::{Load, Pose, skew};
pub(crate) use pose::{axial, inner, outer};
pub(crate) use random::uniform;
#[cfg(feature = "rock")]
pub use rock_mass::{Fragment, Fragments, RockMass, Sliver};
pub use shape::{Form, Part, Shape};
pub use winding::WindingTree;
