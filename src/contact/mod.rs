//! Contact of convex polyhedra by linear programming (Boon, Houlsby & Utili 2012).

mod placed;

pub use placed::Placed;
