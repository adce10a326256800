//! Pictures in space of any engine that is [`Shown`].

mod coarse;
mod fluid;
mod frame;
mod recorder;
mod shown;
mod stage;

pub use recorder::Views;
pub use shown::{Shown, immersed};
