//! Contact of convex blocks by linear programming (Boon, Houlsby & Utili 2012).
//!
//! A [`Resolver`] determines whether two [`Placed`] blocks overlap, and the point, normal, depth and
//! area of their contact. No decision depends on the sign of a rounded number: a
//! plane that separates all vertices proves that there is no contact, a point inside all faces
//! proves that there is one, and a pair with neither proof is [`Verdict::Undecided`].
//!
//! Proofs are tried in the order of their cost: bounding spheres; the plane or the point in the
//! [`Cache`] of the pair; faces, the line of centres and the surroundings of the last point; the
//! linear program. The analytic centre, the normal, and the section of the overlap follow.
//!
//! ```
//! use glam::{DQuat, DVec3};
//! use riprap::{geometry::Pose, rock::contact::{Cache, Options, Placed, Resolver, Verdict}};
//!
//! # fn main() -> riprap::Result<()> {
//! // Two balls of radius 1 m, their centres 1.98 m apart.
//! let ball = |x: f64| {
//!     let pose = Pose::at_rest(DVec3::X * x, DQuat::IDENTITY);
//!     let mut placed = Placed::default();
//!     placed.update_sphere(1.0, DVec3::ZERO, &pose);
//!     placed
//! };
//! let mut resolver = Resolver::new(Options::default());
//! let mut cache = Cache::default();
//! match resolver.resolve(&ball(0.0), &ball(1.98), &mut cache)? {
//!     Verdict::Contact(contact) => {
//!         assert_eq!(contact.normal, DVec3::X);
//!         assert!((contact.overlap - 0.02).abs() < 1e-15);
//!     }
//!     other => panic!("{other:?}"),
//! }
//! # Ok(())
//! # }
//! ```

mod bond;
mod centre;
mod closed_form;
mod pair;
mod polygon;
mod program;
mod resolver;
mod section;
mod thin_gap;

pub use crate::geometry::Placed;
pub use bond::{Bond, BondState};
pub(super) use closed_form::nearest_point;
pub use pair::Cache;
pub use resolver::{ContactGeometry, Counts, Normal, Options, Resolver, Verdict};
pub use thin_gap::{GapShape, ThinGap};
