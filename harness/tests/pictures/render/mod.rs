//! Pictures in space: bodies are where the camera sees them, nearer ones hide farther ones, colours and lengths
//! can be read, and what cannot be drawn is said.

mod bodies;
mod drops;
mod fixture;
mod fluid;
mod frame;
mod refusals;
mod sequences;
mod shading;
mod traces;
