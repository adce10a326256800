//! Pictures in space.

mod fluid;
mod frame;
mod recorder;
mod shown;
mod stage;

pub use recorder::Views;
pub use shown::{immersed, solid_blocks};
