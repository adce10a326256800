//! Motion of rigid and of affine bodies under given forces.

mod affine;
mod damped;
mod held;
mod principal;
mod rotation;

pub(crate) use crate::geometry::axial;
pub use affine::{Affine, Pull, polar};
pub use damped::{first_kick, second_kick};
pub use held::Held;
pub use principal::Principal;
pub use rotation::{spin, turn};
