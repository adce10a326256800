//! Pictures in space.

mod coarse;
mod fluid;
mod frame;
mod recorder;
mod shown;
mod solids;
mod stage;

pub use recorder::Views;
pub use shown::immersed;
pub use solids::solid_blocks;
