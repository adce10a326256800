//! Pictures: what they show is where and what the data are, and what cannot be shown is said.

mod blocks;
mod charts;
mod rig;
mod slices;
