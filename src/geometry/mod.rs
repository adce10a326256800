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
mod columns;
mod convex_parts;
mod hull;
mod joint_set;
mod mesh;
#[cfg(feature = "mesh")]
mod mesh_file;
mod placed;
mod plane_face;
mod polyhedron;
mod pose;
#[cfg(feature = "rock")]
mod rock_mass;
mod shape;
mod terrain;
#[cfg(feature = "mesh")]
mod terrain_file;
mod winding;

pub(crate) use columns::volumes_below;
pub use joint_set::{Compass, JointSet, Persistence, Scatter};
pub use mesh::TriangleMesh;
pub use placed::Placed;
pub(crate) use placed::{bounding_box, clip, min_max};
pub use plane_face::{PlaneFace, Window, area_of, corners, plane_faces};
pub use polyhedron::{HalfSpace, Polyhedron};
pub use pose::{Load, Pose, skew};
pub(crate) use pose::{axial, inner, outer};
#[cfg(feature = "rock")]
pub use rock_mass::{Fragment, Fragments, RockMass, Sliver};
pub use shape::{Form, Part, Shape};
pub use terrain::Terrain;
pub use winding::WindingTree;
