//! The f64 twin itself against exact results.

mod physics;
mod turbulence;
mod walls;
