//! Motion of rigid and of affine bodies under given forces.

mod affine;
mod damped;
mod point_constraints;
mod principal;
mod rotation;

pub(crate) use crate::geometry::axial;
pub use affine::{Affine, Wrench, polar};
pub use damped::{first_kick, second_kick};
pub use point_constraints::PointConstraints;
pub use principal::Principal;
pub use rotation::{spin, turn};
