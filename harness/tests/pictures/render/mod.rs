//! Pictures in space: bodies are drawn where the camera sees them, nearer ones hide farther ones, colours and lengths
//! are readable, and what cannot be drawn is reported.

mod bodies;
mod drops;
mod fixture;
mod fluid;
mod frame;
mod refusals;
mod sequences;
mod shading;
mod traces;
