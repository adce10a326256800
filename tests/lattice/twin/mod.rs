//! The f64 twin itself, compared with exact results.

mod physics;
mod stability;
mod turbulence;
mod walls;
