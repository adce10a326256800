//! Blocks that move: their poses, their loads, and the step of all of them.

mod pose;

pub use pose::{Load, Pose, skew};
