//! Blocks in a fluid.

pub mod array;
pub mod buoyancy;
pub mod crossing;
pub mod cylinder;
pub mod incline_flow;
pub mod lubrication;
pub mod momentum;
pub mod obstacle;
pub mod plates;
pub mod release;
pub mod rotation;
pub mod settling;
pub mod spike;
pub mod volume;
