//! Free water by particles.

pub mod buoyancy;
pub mod dam;
pub mod film;
pub mod maker;
pub mod pushed;
pub mod schemes;
pub mod solitary;
pub mod still;
pub mod wave;
