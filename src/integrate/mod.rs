//! Motion of rigid bodies under given forces.

mod damped;
mod principal;
mod rotation;

pub use damped::{first_kick, second_kick};
pub use principal::Principal;
pub use rotation::{spin, turn};
